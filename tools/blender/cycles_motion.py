# SPDX-License-Identifier: Apache-2.0
"""What moves while the shutter is open, as keyframes. The picture's frame is 1."""
from mathutils import Matrix

from cycles_nodes import Refused

FRAME = 1
STEPS = 5  # Cycles cuts a shutter into 2^(STEPS - 1) pieces, on which it goes straight


def curves(data):
    """The animation curves of a block of data."""
    action = data.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips
            for bag in strip.channelbags for curve in bag.fcurves]


def go_straight(data):
    for curve in curves(data):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def place(placed, matrix, motion=None, times=()):
    """Puts an object to a place in the world; or to one place for each of the times, which are in
    frames after the picture's."""
    placed.matrix_world = matrix
    if not motion:
        return
    placed.rotation_mode = "QUATERNION"
    placed.cycles.motion_steps = STEPS
    before = None
    for there, time in zip(motion, times):
        location, rotation, scale = there.decompose()
        largest = max(abs(n) for row in there.to_3x3() for n in row)
        apart = Matrix.LocRotScale(location, rotation, scale) - there
        if max(abs(n) for row in apart.to_3x3() for n in row) > 1e-5 * largest:
            raise Refused("Blender's keyframes cannot shear what moves")
        if before and rotation.dot(before) < 0:
            rotation.negate()
        before = rotation
        placed.location, placed.rotation_quaternion, placed.scale = location, rotation, scale
        for path in ("location", "rotation_quaternion", "scale"):
            placed.keyframe_insert(path, frame=FRAME + time)
    go_straight(placed)


def zoom(camera, angles, times):
    """Gives a camera one angle of view for each of the times."""
    for angle, time in zip(angles, times):
        camera.angle = angle  # which follows from the lens; that alone takes keys
        camera.keyframe_insert("lens", frame=FRAME + time)
    go_straight(camera)
