"""Shapes, types, batches, exact slopes."""


import flexure
import numpy as np
import pytest


class TestArrays:
    def test_a_batch_is_its_rows(self, scenario: flexure.Scenario) -> None:
        law, robot, held = scenario.controller(), scenario.robot, scenario.open()
        x = np.random.default_rng(2).uniform(-1, 1, (2, 3, 8))
        u = law.torque(x, 0.1)
        assert u.shape == (2, 3, 2)
        q_l, _, dq_l, _ = flexure.views(x)
        for i in np.ndindex(2, 3):
            # In lanes, with sines of their own: ten ulps of them, times the gains.
            np.testing.assert_allclose(u[i], law.torque(x[i], 0.1), rtol=0, atol=1e-13 * abs(u).max())
            np.testing.assert_array_equal(u[i], law.torque(x[:, 1:], 0.1)[i[0], i[1] - 1] if i[1] else u[i])
            for all_, one in [
                (robot.mass_matrix(q_l), robot.mass_matrix(q_l[i])),
                (robot.inverse_dynamics(q_l, dq_l, dq_l), robot.inverse_dynamics(q_l[i], dq_l[i], dq_l[i])),
                (robot.forward_dynamics(x, u), robot.forward_dynamics(x[i], u[i])),
                (robot.energy(x), robot.energy(x[i])),
                (robot.matrices(q_l, dq_l)["dM"], robot.matrices(q_l[i], dq_l[i])["dM"]),
                (held.derivative(0.0, x, u), held.derivative(0.0, x[i], u[i])),
            ]:
                np.testing.assert_array_equal(all_[i], one)
        np.testing.assert_array_equal(robot.forward_dynamics(x, u[0, 0]), robot.forward_dynamics(x, np.broadcast_to(u[0, 0], (2, 3, 2))))
        np.testing.assert_array_equal(held.derivative(0.0, x[0, 0], u), held.derivative(0.0, np.broadcast_to(x[0, 0], x.shape), u))
        assert isinstance(robot.energy(x[0, 0]), float) and robot.energy(x).shape == (2, 3)
        assert law.torque(np.zeros((0, 8)), 0.0).shape == (0, 2)
        times = np.linspace(0.0, 1.0, 6).reshape(2, 3)
        for i in np.ndindex(2, 3):
            np.testing.assert_array_equal(law.torque(x, times)[i], law.torque(x[i], times[i]))
            np.testing.assert_array_equal(law.reference(times)[i], law.reference(times[i]))
        with pytest.raises(ValueError, match=r"t: shape \(3,\); expected one time, or \(2, 3\)"):
            law.torque(x, np.zeros(3))

    def test_whatever_numpy_makes_numbers_of(self, scenario: flexure.Scenario) -> None:
        law = scenario.controller()
        x = np.arange(8) / 16
        u = law.torque(x, 0.0)
        wide = np.zeros((8, 2))
        wide[:, 0] = x
        read_only = x.copy()
        read_only.flags.writeable = False
        for same in [x.tolist(), tuple(x), x.astype(np.float32), wide[:, 0], x[::-1].copy()[::-1], read_only, np.asfortranarray([x])[0]]:
            np.testing.assert_array_equal(law.torque(same, 0.0), u)
        np.testing.assert_array_equal(law.torque(np.asfortranarray([x, x]), 0.0), law.torque([x, x], 0.0))
        np.testing.assert_array_equal(law.torque([1, 0, 1, 0, 0, 0, 0, 0], 0), law.torque([1.0, 0, 1, 0, 0, 0, 0, 0], 0.0))

    def test_exact_slopes(self, scenario: flexure.Scenario) -> None:
        """Against central differences: they are off by h² and by rounding over h, 1e-6 of the largest slope together."""
        law, held, h = scenario.controller(), scenario.open(), 1e-5
        x = np.array([0.3, -0.2, 0.31, -0.22, 0.5, 0.1, 0.4, 0.2])
        u = np.array([1.0, -0.5])
        moved = x + h * np.array([[1], [-1]])[..., None] * np.eye(8)
        quotient = np.subtract(*law.torque(moved, 0.4)).T / (2 * h)
        slopes = law.jacobian(x, 0.4)
        assert np.abs(slopes - quotient).max() < 1e-6 * np.abs(slopes).max()
        A, B = law.linearise(x, u)
        rates = np.subtract(*held.derivative(0.0, moved, np.broadcast_to(u, (2, 8, 2)))).T / (2 * h)
        assert np.abs(A - rates).max() < 1e-6 * np.abs(A).max()
        # Torques act on motors alone, over their inertia.
        np.testing.assert_allclose(B, np.vstack([np.zeros((6, 2)), np.diag(1 / scenario.robot.motor_inertia)]), rtol=1e-14)

    def test_torque_derivatives(self) -> None:
        """Along a polynomial of which the torques' own differences are known to 1e-5 of their size."""
        robot, h = flexure.Robot("planar-2r"), 1e-4
        coefficients = np.random.default_rng(3).uniform(-1, 1, (5, 2))

        def motion(t: float) -> np.ndarray:
            polynomials = [np.polynomial.Polynomial(c) for c in coefficients.T]
            return np.array([[p.deriv(k)(t) if k else p(t) for p in polynomials] for k in range(5)])

        exact = robot.torque_derivatives(motion(0.3))
        q_l = np.array([motion(0.3 + k * h) for k in (-1, 0, 1)])
        tau = robot.inverse_dynamics(q_l[:, 0], q_l[:, 1], q_l[:, 2])
        np.testing.assert_allclose(exact[0], tau[1], rtol=1e-13)
        np.testing.assert_allclose(exact[1], (tau[2] - tau[0]) / (2 * h), rtol=1e-5)
        np.testing.assert_allclose(exact[2], (tau[2] - 2 * tau[1] + tau[0]) / h**2, rtol=1e-4)

    @pytest.mark.parametrize(
        ("bad", "error", "words"),
        [
            (np.zeros(7), ValueError, r"x: shape \(7,\); expected \(…, 8\) = \(q_l, q_m, dq_l, dq_m\)"),
            (np.zeros((8, 3)), ValueError, r"x: shape \(8, 3\)"),
            (0.5, ValueError, r"x: shape \(\)"),
            (["a"] * 8, TypeError, "x: numbers of type <U1; expected real numbers"),
            (np.zeros(8, complex), TypeError, "complex128"),
            ([[1.0], [1.0, 2.0]], TypeError, "x: list is no array of real numbers"),
            (object(), TypeError, "x: numbers of type object"),
            (None, TypeError, "x: numbers of type object"),
        ],
    )
    def test_bad_arrays(self, scenario: flexure.Scenario, bad: object, error: type[Exception], words: str) -> None:
        with pytest.raises(error, match=words):
            scenario.controller().torque(bad, 0.0)

    def test_bad_pairs(self, scenario: flexure.Scenario) -> None:
        robot, law = scenario.robot, scenario.controller()
        with pytest.raises(ValueError, match=r"shapes do not fit: x \(3, 8\), u_m \(2, 2\)"):
            robot.forward_dynamics(np.zeros((3, 8)), np.zeros((2, 2)))
        with pytest.raises(ValueError, match="one motion"):
            law.jacobian(np.zeros((1, 8)), 0.0)
        with pytest.raises(ValueError, match=r"expected \(…, 5, 2\)"):
            robot.torque_derivatives(np.zeros((3, 2)))
        with pytest.raises(ValueError, match="numbers"):
            scenario.open().restore([1.0, 2.0])

    def test_nan_stays_nan(self, scenario: flexure.Scenario) -> None:
        assert np.isnan(scenario.controller().torque(np.full(8, np.nan), 0.0)).all()

    def test_motions(self) -> None:
        x = flexure.motion([0.1, 0.2], dq_m=[1.0, 2.0])
        assert x.tolist() == [0.1, 0.2, 0.1, 0.2, 0.0, 0.0, 1.0, 2.0]
        flexure.views(x).q_m[:] = 5.0
        assert x[2:4].tolist() == [5.0, 5.0]
        with pytest.raises(ValueError, match="4n"):
            flexure.views(np.zeros(7))
