"""The page examples/validation: its cells run, its table is well formed, rows are read as written."""

import pytest

from examples.validation import results
from tests.conftest import REPOSITORY, run_page

FOLDER = REPOSITORY / "examples" / "validation"


def test_cells_run_in_order(monkeypatch, capsys):
    run_page(FOLDER, monkeypatch)
    lines = capsys.readouterr().out.strip().splitlines()
    assert len(lines) == 2 + len(results.read())
    assert len({line.count("|") for line in lines}) == 1


def test_recorded_rows_are_within_their_bounds():
    rows = results.read()
    assert not [text for row in rows for text in row.failures]
    names = {row.case for row in rows}
    assert len(names) >= 12
    assert len(names) < len(rows)


def test_rows_survive_the_file(tmp_path):
    path = tmp_path / "results.csv"
    first = results.Row("a, with comma", "x", 2.0, 2.1, 0.1, order=1.9, least_order=1.8)
    second = results.Row("b", "y", 0.0, 1e-3, 2e-3, error=1e-3, bound=5e-3)
    results.write([first, second], path)
    results.write([results.Row("b", "z", 1.0, 1.0, 0.1)], path)
    kept, replaced = results.read(path)
    assert kept.error == pytest.approx(first.error)
    assert (kept.order, kept.bound, kept.meets_target) == (1.9, 0.1, True)
    assert (replaced.case, replaced.quantity, replaced.order) == ("b", "z", None)


def test_failures_say_what_is_missed():
    row = results.Row("case", "x", 1.0, 1.2, 0.1, bound=0.3, order=1.2, least_order=1.8)
    assert not row.meets_target
    (text,) = row.failures
    assert "order 1.2 is below 1.8" in text
    (text,) = results.Row("case", "x", 1.0, 1.2, 0.1).failures
    assert "exceeds 0.1" in text
