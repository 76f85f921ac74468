"""A log in the formats of other programs: ``.csv``, and ``.parquet`` with the library of the extra ``[parquet]``.

Numbers are those of the log, in its units: what is read back is the same double.
"""

import csv
import io
import json
from typing import IO, Any

from robolang.logs.quantities import Column
from robolang.logs.table import Table
from runtime.core.faults import Fault


def write_csv(stream: IO[bytes], table: Table) -> None:
    """Write a header of names with units, and a line for each row."""
    text = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
    try:
        # Python writes the shortest number that reads back as the same double
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(_heading, table.columns))
        for piece in table.pieces():
            writer.writerows(zip(*(column.tolist() for column in piece), strict=True))
    finally:
        # the stream is not ours to close
        text.detach()


def _heading(column: Column) -> str:
    return f"{column.name} [{column.unit}]" if column.unit not in ("", "-") else column.name


def write_parquet(stream: IO[bytes], table: Table) -> None:
    """Write a column for each number, with its unit, and what the run was of; ``Fault`` RBL839 without the library."""
    pa, pq = _arrow()
    kept = {} if table.log.meta is None else {"robolang": json.dumps(table.log.meta, allow_nan=False)}
    fields = [
        pa.field(column.name, pa.from_numpy_dtype(values.dtype), nullable=False, metadata={"unit": column.unit})
        for column, values in zip(table.columns, table.empty(), strict=True)
    ]
    schema = pa.schema(fields, metadata=kept)
    # its default writes larger files of numbers that hardly repeat
    with pq.ParquetWriter(stream, schema, compression="zstd") as writer:
        for piece in table.pieces():
            writer.write_batch(pa.record_batch([pa.array(column) for column in piece], schema=schema))


def check_parquet() -> None:
    """Refuse where no ``.parquet`` can be written: ``Fault`` RBL839."""
    _arrow()


def _arrow() -> tuple[Any, Any]:
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError:
        raise Fault(
            "RBL839", "a .parquet needs the library pyarrow", "pip install 'robolang[parquet]'; .csv needs none"
        ) from None
    return pa, pq
