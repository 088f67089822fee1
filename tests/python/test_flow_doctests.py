"""The examples in the docstrings."""

import doctest
import importlib

import numpy as np
import pytest
from peclet import flow


@pytest.mark.parametrize("module", ["_checks", "flow.fields", "flow.parameters", "flow.solver"])
def test_examples_in_docstrings(module):
    names = {"Solver": flow.Solver, "np": np}
    result = doctest.testmod(importlib.import_module(f"peclet.{module}"), extraglobs=names)
    assert result.attempted > 0
    assert result.failed == 0
