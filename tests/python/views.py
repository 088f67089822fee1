"""Views of the memory that kernels use."""

import pytest
from peclet import flow

readable = flow.execution_space != "Cuda"
needs_readable_views = pytest.mark.skipif(not readable, reason="views are memory of the GPU")
