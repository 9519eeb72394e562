"""Sweeps: many runs of a scenario whose numbers change, as rows of Parquet files."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path as _Local
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from ._flexure import FlexureError, Sweep
from ._jobs import Path, _watched, simulate
from ._progress import Progress
from ._run import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame as _DataFrame

MANIFEST = "sweep.json"
"""The file that says what sweep a folder is of."""


class Store(Protocol):
    """Where rows are kept. A file is there as a whole or not at all."""

    def names(self) -> set[str]:
        """The files that are there."""

    def read(self, name: str) -> bytes:
        """A file."""

    def end(self, name: str, size: int) -> bytes:
        """The last `size` bytes of a file, or all of it."""

    def open(self, sweep: Sweep) -> None:
        """Makes it the place of this sweep; an error if it is that of another."""

    def complete(self, sweep: Sweep, first: int, end: int, threads: int | None, told: Callable[[float], object] | None) -> None:
        """Computes the shards from `first` to before `end` that are not there."""


class Folder:
    """A folder of this machine, or of a file system that all machines share."""

    def __init__(self, path: str) -> None:
        self.path = _Local(path)

    def names(self) -> set[str]:
        return set(os.listdir(self.path)) if self.path.is_dir() else set()

    def read(self, name: str) -> bytes:
        return (self.path / name).read_bytes()

    def end(self, name: str, size: int) -> bytes:
        with open(self.path / name, "rb") as file:
            file.seek(-min(size, os.fstat(file.fileno()).st_size), os.SEEK_END)
            return file.read()

    def open(self, sweep: Sweep) -> None:
        sweep._complete(self.path, 0, 0)

    def complete(self, sweep: Sweep, first: int, end: int, threads: int | None, told: Callable[[float], object] | None) -> None:
        sweep._complete(self.path, first, end, threads=threads, progress=told)


class Remote:
    """Files behind a URL, by fsspec. One that is written appears when it is whole, as object stores have it; elsewhere it is renamed."""

    OBJECT_STORES = frozenset({"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "oss", "r2", "memory"})

    def __init__(self, url: str, options: Mapping[str, Any]) -> None:
        try:
            import fsspec
        except ImportError:
            raise ImportError(f"{url} is a URL: pip install fsspec, and the package for this kind of storage") from None
        self.files, self.path = fsspec.core.url_to_fs(url, **options)

    def names(self) -> set[str]:
        try:
            found = self.files.ls(self.path, detail=False, refresh=True)
        except FileNotFoundError:
            return set()
        return {name.rstrip("/").rsplit("/", 1)[-1] for name in found}

    def read(self, name: str) -> bytes:
        return bytes(self.files.cat_file(f"{self.path}/{name}"))

    def end(self, name: str, size: int) -> bytes:
        path = f"{self.path}/{name}"
        return bytes(self.files.cat_file(path, start=max(self.files.size(path) - size, 0)))

    def write(self, name: str, content: bytes) -> None:
        protocol = self.files.protocol
        protocols = {protocol} if isinstance(protocol, str) else set(protocol)
        path = f"{self.path}/{name}"
        if protocols & self.OBJECT_STORES:
            self.files.pipe_file(path, content)
            return
        self.files.makedirs(self.path, exist_ok=True)
        temporary = f"{self.path}/.flexure-{os.getpid()}-{name}.tmp"
        self.files.pipe_file(temporary, content)
        self.files.mv(temporary, path)

    def open(self, sweep: Sweep) -> None:
        names = self.names()
        if MANIFEST in names:
            there = Sweep.from_document(self.read(MANIFEST).decode())
            if there != sweep:
                raise FlexureError(f"{self.path} is of another sweep: {there.name}, {there.rows} rows\n  help: name another place")
        elif any(name.endswith(".parquet") for name in names):
            raise FlexureError(f"{self.path} has rows and no {MANIFEST}\n  help: name another place")
        else:
            self.write(MANIFEST, sweep.document().encode())

    def complete(self, sweep: Sweep, first: int, end: int, threads: int | None, told: Callable[[float], object] | None) -> None:
        there = self.names()
        for shard in range(first, end):
            name = sweep.part_name(shard)
            if name not in there:
                self.write(name, sweep.shard(shard, threads=threads))
            if told:
                told((shard + 1 - first) / (end - first))


def _store(where: str, options: Mapping[str, Any] | None) -> Store:
    return Remote(where, options or {}) if "://" in where else Folder(where)


def _shard_of(name: str) -> int:
    """The shard whose file has this name, part-00012.parquet."""
    return int(name[5:-8])


class Rows:
    """The rows of a sweep that are there: what `sweep` computed, or a folder or URL of one."""

    def __init__(self, where: Path, *, storage_options: Mapping[str, Any] | None = None) -> None:
        self.where = os.fspath(where)
        self.store = _store(self.where, storage_options)
        if MANIFEST not in self.store.names():
            raise FlexureError(f"{self.where} has no {MANIFEST}: it is no folder of a sweep\n  help: name what `sweep` wrote to")
        self.sweep = Sweep.from_document(self.store.read(MANIFEST).decode())

    @property
    def parts(self) -> list[str]:
        """The files that are there, in the order of their rows."""
        return sorted((name for name in self.store.names() if name.startswith("part-") and name.endswith(".parquet")), key=_shard_of)

    @property
    def complete(self) -> bool:
        """Whether every row is there."""
        return len(self.parts) == self.sweep.shards

    def summary(self) -> dict[str, Any]:
        """How many rows there are of each status, and how each metric is spread over them. Only the ends of the files are read."""
        ends = []
        for name in self.parts:
            last = self.store.end(name, 1 << 16)
            size = int.from_bytes(last[-8:-4], "little") + 8
            ends.append((_shard_of(name), (last if len(last) >= size else self.store.end(name, size))[-size:-8]))
        return self.sweep._statistics(ends)

    def columns(self, *names: str) -> dict[str, NDArray[Any]]:
        """Columns of the rows by their names, all of them if none is named: row, seed, status, parameters, metrics (NaN where a run has
        none)."""
        return {name: np.asarray(column) for name, column in self.sweep._table([(_shard_of(name), self.store.read(name)) for name in self.parts], list(names or self.sweep.columns)).items()}

    def to_pandas(self) -> _DataFrame:
        """A DataFrame with the row as index. Needs pandas."""
        import pandas

        columns = self.columns()
        return pandas.DataFrame(columns, index=pandas.Index(columns.pop("row"), name="row"))

    def replay(self, row: int, *, progress: Progress = None) -> Run:
        """Runs a row again, with its trace."""
        return simulate(self.sweep.scenario(row), progress=progress)

    def heatmap(self, x: str, y: str, value: str = "rms_e_l") -> Figure:
        """A metric over two parameters of a grid: its mean over seeds and other parameters. Needs matplotlib."""
        from ._sweep_plot import heatmap

        return heatmap(self, x, y, value)

    def scatter(self, x: str, y: str, value: str = "rms_e_l") -> Figure:
        """Every row at two of its parameters or metrics, coloured by a metric. Needs matplotlib."""
        from ._sweep_plot import scatter

        return scatter(self, x, y, value)

    def __repr__(self) -> str:
        return f"Rows({self.where}: {len(self.parts)} of {self.sweep.shards} shards of {self.sweep!r})"


def sweep(
    sweep: Sweep | Path,
    out: Path | None = None,
    *,
    shards: range | None = None,
    engine: Literal["local", "ray"] = "local",
    threads: int | None = None,
    storage_options: Mapping[str, Any] | None = None,
    set: Any = None,
    allow_outside: bool = False,
    progress: Progress = None,
) -> Rows:
    """Computes the rows of a sweep that are not there yet, as `flexure sweep`, into a folder or a URL of fsspec; default out/NAME.

    Rows are the same bits whatever computes them, in any order. "local" uses all cores of this machine, or so many `threads`; "ray" the
    cluster that `ray.init` was called for, or this machine, one core a shard: `out` is then a place that all machines see. What was
    written stays when it is broken off or killed; the same call goes on.
    """
    if not isinstance(sweep, Sweep):
        sweep = Sweep(sweep, set=set, allow_outside=allow_outside)
    elif set is not None:
        raise TypeError("set: changes are made where a sweep is read: Sweep(path, set=...)")
    asked = range(sweep.shards) if shards is None else shards
    if not isinstance(asked, range):
        raise TypeError(f"shards: {asked!r}; expected a range, as range(0, 8)")
    if asked.step != 1 or not 0 <= asked.start <= asked.stop <= sweep.shards:
        raise ValueError(f"shards: {asked}; expected a range within 0 to {sweep.shards}")
    where = os.path.join("out", sweep.name) if out is None else os.fspath(out)
    store = _store(where, storage_options)
    store.open(sweep)
    if engine == "local":
        _watched(sweep.name, progress, lambda told: store.complete(sweep, asked.start, asked.stop, threads, told))
    elif engine == "ray":
        if threads is not None:
            raise TypeError("threads: a shard takes one core of a Ray cluster; call ray.init(num_cpus=...) before")
        names = store.names()
        missing = [shard for shard in asked if sweep.part_name(shard) not in names]
        _watched(sweep.name, progress, lambda told: _by_ray(sweep, where, storage_options, missing, told))
        names = store.names()
        lost = [shard for shard in asked if sweep.part_name(shard) not in names]
        if lost:
            raise FlexureError(f"{where}: {len(lost)} shards were computed and are not there\n  help: name a place that all workers see, no memory of their own")
    else:
        raise ValueError(f'engine: {engine!r}; expected "local" or "ray"')
    return Rows(where, storage_options=storage_options)


_READ: dict[str, Sweep] = {}
"""The last sweep of a worker, by its document: it gets many shards of one."""


def _again(document: str) -> Sweep:
    if document not in _READ:
        _READ.clear()
        _READ[document] = Sweep.from_document(document)
    return _READ[document]


def _shard(document: str, where: str, options: Mapping[str, Any] | None, shard: int) -> int:
    """What a worker does: nothing but the number of the shard comes back."""
    _store(where, options).complete(_again(document), shard, shard + 1, 1, None)
    return shard


AHEAD = 4
"""Shards that wait for each core, so that none is idle; more would only fill the memory of the driver."""


def _by_ray(sweep: Sweep, where: str, options: Mapping[str, Any] | None, shards: list[int], told: Callable[[float], object] | None) -> None:
    try:
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        import ray
    except ImportError:
        raise ImportError('engine="ray" needs Ray: pip install ray') from None
    if "://" not in where:
        where = os.path.abspath(where)
    is_ours = not ray.is_initialized()
    if is_ours:
        ray.init(include_dashboard=False, log_to_driver=False, object_store_memory=100_000_000)
    try:
        work = ray.remote(num_cpus=1, max_retries=3)(_shard)
        document = ray.put(sweep.document())
        resources: dict[str, float] = ray.cluster_resources()  # type: ignore[no-untyped-call, unused-ignore]
        ahead = AHEAD * max(int(resources.get("CPU", 1)), 1)
        waiting, done = iter(shards), 0
        running: list[Any] = []
        try:
            while True:
                running += [work.remote(document, where, options, shard) for _, shard in zip(range(ahead - len(running)), waiting)]
                if not running:
                    return
                # Short, so that Ctrl-C is seen.
                ready, running = ray.wait(running, timeout=0.1)
                ray.get(ready)
                done += len(ready)
                if told:
                    told(done / len(shards))
        except BaseException:
            for task in running:
                ray.cancel(task)
            raise
    finally:
        if is_ours:
            ray.shutdown()


