"""Another name of peclet.core.geom: importing either gives the same module object."""

import sys

from peclet.core import geom

sys.modules[__name__] = geom
