"""A square cavity heated from one side: balance and symmetry; the page has the numbers."""

import numpy as np
import pytest

from examples.validation.heat import heated_cavity, nusselt_numbers


@pytest.mark.parametrize(("cells", "rayleigh"), [(16, 1000), (24, 10000)])
def test_what_enters_leaves_and_halves_mirror_each_other(cells, rayleigh):
    solver = heated_cavity(cells, rayleigh)
    hot, cold = nusselt_numbers(solver)
    assert hot == pytest.approx(cold, rel=1e-5)
    t = solver.get_field("temperature")
    assert t + t[::-1, ::-1] == pytest.approx(np.ones_like(t), abs=1e-5)
    # no fluid is warmer than the hot wall or colder than the cold one
    assert t.min() > 0
    assert t.max() < 1
    v = solver.get_v()
    assert v[:2].max() > 0
    assert v[-2:].min() < 0
