"""The cases of the page examples/validation: coarse versions always, full versions with the marker slow."""

import dataclasses

import numpy as np
import pytest

from examples.validation.cases import CASES
from examples.validation.results import Row, with_order


def check(rows):
    failures = [text for row in rows for text in row.failures]
    assert not failures, "\n".join(failures)


@pytest.mark.parametrize("case", [case for case in CASES if case.small], ids=lambda case: case.name)
def test_coarse_version(case):
    check(case.small())


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_full_version(case):
    check(case.full({}))


def test_order_is_that_of_all_rows_together():
    """Errors of 1.2 / n^2 and -0.9 / n^2 times their targets, and one that is nothing beside them."""

    def compare(n):
        errors = zip((1.2 / n**2, -0.09 / n**2, 1e-9), (1.0, 0.1, 1.0), strict=True)
        return [Row("case", str(n), 0.0, error, target, error=error) for error, target in errors]

    rows = with_order(compare, (8, 12), least_order=1.9)
    assert [row.quantity for row in rows] == ["12"] * 3
    np.testing.assert_allclose([row.order for row in rows], 2)
    assert not any("order" in text for row in rows for text in row.failures)
    (text,) = dataclasses.replace(rows[2], least_order=2.1).failures
    assert "is below 2.1" in text
