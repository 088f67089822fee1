"""Solids made of signed distances: build a scene, evaluate it, measure its bodies.

>>> from peclet.core import geom
>>> scene = geom.SceneBuilder()
>>> ball = scene.add_leaf("sphere", [2.0], translation=[1.0, 0.0, 0.0])
>>> scene.eval_root(ball, [[1.0, 0.0, 0.0], [4.0, 0.0, 0.0]])
array([-2.,  1.])
>>> round(scene.body_properties(ball, [-2, -3, -3], [4, 3, 3])["volume"], 6)
33.510322

``peclet.geom`` is another name of this module.
"""

from peclet import _environment  # noqa: F401
from peclet.core.geom._geom import SceneBuilder, build_toolchain

__all__ = ["SceneBuilder", "build_toolchain"]
