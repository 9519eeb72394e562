//! Accelerations over one time step with dry friction that holds exactly.
//!
//! With friction torques f and A the matrix of the step, A a = b − f, f_i ∈ F_i sign(v_i + h a_i) where the sign of zero is
//! all of [−1, 1]: the minimum of ½ aᵀA a − bᵀa + Σ F_i |v_i + h a_i| / h, which is convex. Who slides which way is found
//! by an active set, that is Newton's method for semismooth equations (Hintermüller, Ito & Kunisch, *SIAM J. Optim.* 13,
//! 2002), and by coordinate descent if that goes round in circles.

use flexure_core::linalg::{Matrix, Vector};

use crate::plant::Sides;

/// Rounds of the active set; two or three are usual.
const ROUNDS: usize = 12;

/// Sweeps of coordinate descent.
const SWEEPS: usize = 300;

/// A joint that turns back within this part of a step does so at its start.
const AT_ONCE: f64 = 0.01;

/// What holds does not let go for a rounding error in the torque.
const ROUNDING: f64 = 1e-12;

/// A time step to be solved: links first, motors second in every pair.
pub(crate) struct Stiction<const N: usize> {
    /// The links' block of A [kg m²].
    pub link: Matrix<f64, N, N>,
    /// The block between them: a row per link, a column per motor [kg m²].
    pub between: Matrix<f64, N, N>,
    /// The motors' block of A, which is diagonal [kg m²].
    pub motor: Vector<f64, N>,
    /// b, torques without friction [N m].
    pub load: Sides<N>,
    /// F, the largest friction torques [N m].
    pub friction: Sides<N>,
    /// Speeds before the step [rad/s].
    pub speed: Sides<N>,
    /// Length of the step in s.
    pub h: f64,
    /// Number of joints, at most N; others couple to none.
    pub joints: usize,
}

/// Friction torque [N m] of each joint that slides; none where friction holds.
pub(crate) type Slides<const N: usize> = [[Option<f64>; N]; 2];

/// A solved step.
pub(crate) struct Slid<const N: usize> {
    pub accelerations: Sides<N>,
    /// Torques against the motion [N m].
    pub friction: Sides<N>,
    pub slides: Slides<N>,
}

const SIDES: [usize; 2] = [0, 1];

impl<const N: usize> Stiction<N> {
    pub(crate) fn solve(&self) -> Slid<N> {
        let mut slides = self.guess();
        for _ in 0..ROUNDS {
            let accelerations = self.accelerations(&slides);
            let judged = self.judged(&slides, &accelerations);
            if judged == slides {
                return self.slid(slides, accelerations);
            }
            slides = judged;
        }
        let slides = self.descended();
        self.slid(slides, self.accelerations(&slides))
    }

    /// The part of the step until the first joint turns back that slides the other way at its end, if there is one and it is not at once. It
    /// is slowed down until then by the friction that it has now, not by that at the end.
    pub(crate) fn first_turn(&self, solved: &Slid<N>) -> Option<f64> {
        let turn = |(side, i): (usize, usize)| {
            let (v, most) = (self.speed[side][i], self.friction[side][i]);
            let after = solved.slides[side][i].filter(|&after| after * v < 0.0)?;
            let slower = solved.accelerations[side][i] - (toward(v, most) - after) / self.inertia(side, i);
            Some(-v / (slower * self.h))
        };
        let joints = SIDES.into_iter().flat_map(|side| (0..self.joints).map(move |i| (side, i)));
        joints.filter_map(turn).filter(|part| (AT_ONCE..1.0).contains(part)).min_by(f64::total_cmp)
    }

    fn slid(&self, slides: Slides<N>, accelerations: Sides<N>) -> Slid<N> {
        let friction = SIDES.map(|side| {
            Vector::from_fn(|i| slides[side][i].unwrap_or_else(|| self.held(side, i, &accelerations)))
        });
        Slid { accelerations, friction, slides }
    }

    /// What moves slides on, what rests rests.
    fn guess(&self) -> Slides<N> {
        SIDES.map(|side| {
            std::array::from_fn(|i| {
                let (v, most) = (self.speed[side][i], self.friction[side][i]);
                if v == 0.0 && most > 0.0 { None } else { Some(toward(v, most)) }
            })
        })
    }

    /// The torque of friction that holds joint `i` [N m].
    #[inline]
    fn held(&self, side: usize, i: usize, [link, motor]: &Sides<N>) -> f64 {
        let others = if side == 0 {
            self.link.row(i).dot(link) + self.between.row(i).dot(motor)
        } else {
            self.between.column(i).dot(link) + self.motor[i] * motor[i]
        };
        self.load[side][i] - others
    }

    /// Who slides by the accelerations that follow from `slides`.
    fn judged(&self, slides: &Slides<N>, accelerations: &Sides<N>) -> Slides<N> {
        SIDES.map(|side| {
            std::array::from_fn(|i| {
                let most = self.friction[side][i];
                if most == 0.0 {
                    return Some(0.0);
                }
                // Beyond ±F it slides: the torque that friction would have to hold, and the speed in units of torque.
                let beyond = match slides[side][i] {
                    None => self.held(side, i, accelerations) * (1.0 - ROUNDING),
                    Some(torque) => {
                        let speed = self.speed[side][i] + self.h * accelerations[side][i];
                        torque + self.inertia(side, i) / self.h * speed
                    }
                };
                (beyond.abs() > most).then_some(toward(beyond, most))
            })
        })
    }

    fn inertia(&self, side: usize, i: usize) -> f64 {
        if side == 0 { self.link[(i, i)] } else { self.motor[i] }
    }

    /// Accelerations if `slides` is who slides [rad/s²]: what holds comes to rest.
    fn accelerations(&self, slides: &Slides<N>) -> Sides<N> {
        let stopped = |side: usize, i: usize| -self.speed[side][i] / self.h;
        let (mut mass, mut b) = (self.link, self.load[0]);
        // Motors out: those that hold are known, the others follow the links.
        let known: Vector<f64, N> = Vector::from_fn(|j| match slides[1][j] {
            None => stopped(1, j),
            Some(friction) => (self.load[1][j] - friction) / self.motor[j],
        });
        b -= self.between * known;
        for j in (0..self.joints).filter(|&j| slides[1][j].is_some()) {
            for k in 0..self.joints {
                for l in 0..=k {
                    mass[(k, l)] -= self.between[(k, j)] * self.between[(l, j)] / self.motor[j];
                }
            }
        }
        let link = links(mass, b, &slides[0], &Vector::from_fn(|k| stopped(0, k)));
        let motor = Vector::from_fn(|j| match slides[1][j] {
            None => known[j],
            Some(_) => known[j] - self.between.column(j).dot(&link) / self.motor[j],
        });
        [link, motor]
    }

    /// Who slides by coordinate descent: one joint at a time, exactly.
    fn descended(&self) -> Slides<N> {
        let mut a = SIDES.map(|side| self.speed[side].scaled(-1.0 / self.h));
        let mut slides: Slides<N> =
            SIDES.map(|side| self.friction[side].0.map(|most| (most == 0.0).then_some(0.0)));
        for _ in 0..SWEEPS {
            let before = a;
            for side in SIDES {
                for i in 0..N {
                    let (inertia, most) = (self.inertia(side, i), self.friction[side][i]);
                    let momentum = inertia * (self.speed[side][i] / self.h + a[side][i]);
                    // Torque left if the joint stopped: soft threshold.
                    let left = self.held(side, i, &a) + momentum;
                    slides[side][i] = (left.abs() > most).then_some(toward(left, most));
                    let rest = -self.speed[side][i] / self.h;
                    a[side][i] = slides[side][i].map_or(rest, |friction| rest + (left - friction) / inertia);
                }
            }
            if before == a {
                break;
            }
        }
        slides
    }
}

/// Solves for the links that slide, of whose matrix the lower triangle is given; the others are `stopped`.
fn links<const N: usize>(
    mut mass: Matrix<f64, N, N>,
    mut b: Vector<f64, N>,
    slides: &[Option<f64>; N],
    stopped: &Vector<f64, N>,
) -> Vector<f64, N> {
    for k in 0..N {
        b[k] -= slides[k].unwrap_or(0.0);
    }
    for k in (0..N).filter(|&k| slides[k].is_none()) {
        for l in (0..N).filter(|&l| l != k) {
            let (row, column) = (k.max(l), k.min(l));
            b[l] -= mass[(row, column)] * stopped[k];
            mass[(row, column)] = 0.0;
        }
    }
    for k in (0..N).filter(|&k| slides[k].is_none()) {
        mass[(k, k)] = 1.0;
        b[k] = stopped[k];
    }
    mass.ldl().solve(&b)
}

/// `size` with the sign of `direction`.
#[inline]
fn toward(direction: f64, size: f64) -> f64 {
    size.copysign(direction)
}

#[cfg(test)]
mod tests {
    use super::{Matrix, SIDES, Slid, Stiction, Vector};

    const N: usize = 3;

    /// Numbers in [−1, 1), the same in every run.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from(u32::try_from(self.0 >> 33).expect("31 bits")) / f64::from(1_u32 << 30) - 1.0
        }

        fn vector(&mut self) -> Vector<f64, N> {
            Vector::from_fn(|_| self.next())
        }
    }

    /// Links and motors coupled strongly, speeds of zero among others, friction of the size of the loads, none among it.
    fn problem(numbers: &mut Numbers) -> Stiction<N> {
        let root: Matrix<f64, N, N> = Matrix::from_fn(|_, _| numbers.next());
        let between = Matrix::from_fn(|_, _| 0.5 * numbers.next());
        let motor = numbers.vector().map(|x| 0.2 + x.abs());
        // Definite by construction: what eliminating the motors takes away is there.
        let carried: Matrix<f64, N, N> =
            Matrix::from_fn(|k, l| (0..N).map(|j| between[(k, j)] * between[(l, j)] / motor[j]).sum());
        let link = root * root.transpose() + Matrix::identity().scaled(0.01) + carried;
        let some = |numbers: &mut Numbers, scale: f64| {
            SIDES.map(|_| numbers.vector().map(|x| if x > 0.3 { 0.0 } else { scale * x }))
        };
        let load = SIDES.map(|_| numbers.vector());
        let friction = some(numbers, 1.0).map(|side| side.map(f64::abs));
        Stiction { link, between, motor, load, friction, speed: some(numbers, 1e-3), h: 1e-3, joints: N }
    }

    /// Newton's law, and friction within its bounds: at them against the motion where there is any.
    fn check(problem: &Stiction<N>, solved: &Slid<N>) {
        for side in SIDES {
            for i in 0..N {
                let (friction, most) = (solved.friction[side][i], problem.friction[side][i]);
                let missing = problem.held(side, i, &solved.accelerations) - friction;
                // Condition numbers up to 1e4, loads of 1 N m.
                assert!(missing.abs() < 1e-11, "{missing} N m unbalanced");
                assert!(friction.abs() <= most * (1.0 + 1e-11), "{friction} of {most} N m");
                let speed = problem.speed[side][i] + problem.h * solved.accelerations[side][i];
                if solved.slides[side][i].is_some() {
                    assert!(
                        friction * speed >= 0.0 && friction.abs() >= most,
                        "{friction} N m at {speed} rad/s"
                    );
                } else {
                    assert!(speed.abs() < 1e-18, "held at {speed} rad/s");
                }
            }
        }
    }

    #[test]
    fn steps_obey_newton_and_coulomb() {
        let mut numbers = Numbers(1);
        let (mut held, mut slid) = (0, 0);
        for _ in 0..20_000 {
            let problem = problem(&mut numbers);
            let solved = problem.solve();
            check(&problem, &solved);
            let moving = solved.slides.iter().flatten().flatten().count();
            (held, slid) = (held + 2 * N - moving, slid + moving);
        }
        assert!(held > 20_000 && slid > 20_000, "{held} held, {slid} slid: both happen often");
    }

    /// The answer is unique, so both ways find it.
    #[test]
    fn descent_finds_the_same() {
        let mut numbers = Numbers(2);
        let mut differences = 0;
        for _ in 0..2000 {
            let problem = problem(&mut numbers);
            differences += u32::from(problem.descended() != problem.solve().slides);
        }
        // Descent converges slowly where links are nearly dependent: then it is cut off.
        assert!(differences < 40, "{differences} of 2000 differ");
    }
}
