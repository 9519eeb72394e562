"""Traces as tables and figures."""

import pickle
from pathlib import Path

import flexure
import numpy as np
import pytest


class TestTables:
    def test_pandas(self, run: flexure.Run) -> None:
        pandas = pytest.importorskip("pandas")
        table = run.trace.to_pandas()
        assert table.index.name == "t" and list(table) == [name for name in run.trace if name != "t"]
        assert isinstance(table, pandas.DataFrame)
        np.testing.assert_array_equal(pandas.DataFrame(run.trace)["u_m1"], run.trace["u_m1"])

    def test_arrow(self, run: flexure.Run) -> None:
        pyarrow = pytest.importorskip("pyarrow")
        table = pyarrow.RecordBatchReader.from_stream(run.trace).read_all()
        assert table.column_names == list(run.trace)
        assert table.schema.field("u_m1").metadata == {b"unit": b"N m"}
        np.testing.assert_array_equal(table["u_m1"].to_numpy(), run.trace["u_m1"])

    def test_plot(self, run: flexure.Run, tmp_path: Path) -> None:
        pytest.importorskip("matplotlib")
        run.plot().savefig(tmp_path / "run.png")
        assert (tmp_path / "run.png").stat().st_size > 20_000

    def test_names(self, run: flexure.Run) -> None:
        with pytest.raises(KeyError, match="columns are t, q_l1"):
            run.trace["q"]
        again = pickle.loads(pickle.dumps(run))
        np.testing.assert_array_equal(again.trace["u_m1"], run.trace["u_m1"])
        assert again.trace.units == run.trace.units and again.summary == run.summary and again != run
        assert run.trace.joints("q_l").shape == (len(run.trace["t"]), 2)
        assert "follows" in repr(run) and "two-link" in repr(run.scenario)
