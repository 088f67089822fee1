"""Results of runs that do the same."""

import numpy as np
from peclet import flow

#: Whether sums over the surfaces of bodies are added up in a fixed order: on a GPU they are not.
SUMS_ARE_REPEATABLE = flow.execution_space != "Cuda"


def assert_same(actual, expected, name=""):
    """Equal bit by bit, or to rounding where sums are not repeatable."""
    expected = np.asarray(expected)
    if SUMS_ARE_REPEATABLE or expected.dtype.kind != "f":
        np.testing.assert_array_equal(actual, expected, err_msg=name)
    else:
        largest = np.abs(expected).max(initial=0)
        np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-10 * largest, err_msg=name)
