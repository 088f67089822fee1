"""The cases of the page examples/validation: coarse versions always, full versions with the marker slow."""

import pytest

from examples.validation.cases import CASES


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
