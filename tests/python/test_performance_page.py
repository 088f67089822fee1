"""The page examples/performance and the harness of the benchmarks: cells run, tables are well formed."""

import csv
import json
import re

import numpy as np
import pytest

from examples.performance import tables
from tests.benchmarks import harness
from tests.conftest import REPOSITORY, run_page

FOLDER = REPOSITORY / "examples" / "performance"
BENCHMARKS = [
    path.stem.removeprefix("bench_") for path in (REPOSITORY / "tests" / "benchmarks").glob("bench_*.*")
]


def test_cells_run_in_order(monkeypatch, capsys):
    run_page(FOLDER, monkeypatch)
    shown = capsys.readouterr().out.strip().split("\n\n")
    assert len(shown) == len(tables.NAMES) + 1
    for table in shown:
        assert len({line.replace("\\|", "").count("|") for line in table.splitlines()}) == 1


def test_every_table_is_shown():
    assert set(tables.NAMES) <= set(BENCHMARKS)
    assert {path.stem for path in tables.DATA.glob("*.json")} == set(tables.NAMES)
    text = (FOLDER / "index.qmd").read_text(encoding="utf-8")
    for name in tables.NAMES:
        assert f'"{name}"' in text
        table = tables.read(name)
        assert table.name == name
        assert re.fullmatch(r"20\d\d-\d\d-\d\d", table.date)
        assert set(table.machine) == set(harness.describe_machine())


@pytest.fixture
def table():
    table = harness.Table("made_up", harness.QUANTITIES)
    table.add("ratio, of two", 1.25, "", ">= 1")
    table.add("a time", 0.123456789, "s")
    return table


def test_tables_print_in_columns(table):
    lines = str(table).splitlines()
    assert [line.split()[0] for line in lines] == ["quantity", "ratio,", "a"]
    end = lines[0].index("value") + len("value")
    assert [line[:end].split()[-1] for line in lines] == ["value", "1.25", "0.1235"]


def test_tables_are_written_as_read(table, tmp_path, monkeypatch):
    table.write(tmp_path / "made_up.csv")
    with (tmp_path / "made_up.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[:2] == [list(harness.QUANTITIES), ["ratio, of two", "1.25", "", ">= 1"]]
    table.write(tmp_path / "made_up.json")
    monkeypatch.setattr(tables, "DATA", tmp_path)
    read = tables.read("made_up")
    assert (read.columns, len(read.rows)) == (list(harness.QUANTITIES), 2)
    assert read.value("a time") == pytest.approx(0.1235)
    assert read.rows[1][3] is None
    assert "≥ 1" in read.markdown()


def test_rows_have_one_entry_per_column(table):
    table.rows[0].pop()
    with pytest.raises(ValueError, match="made_up: expected 4 entries"):
        tables.Recorded("made_up", "", {}, list(table.columns), table.rows)


def test_copying_has_a_bandwidth(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    assert harness.threads() == 1
    assert np.isfinite(harness.copy_bandwidth(megabytes=1))
    assert json.dumps(harness.describe_machine())
