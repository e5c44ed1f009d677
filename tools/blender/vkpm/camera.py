"""The camera as vkpm's: place, angle, lens."""

import math

from .space import axis, place


class Unsupported(Exception):
    """Says what cannot be rendered, and what to do."""


def film_size(scene):
    """Pixels, width and height."""
    render = scene.render
    return [
        max(1, int(side * render.resolution_percentage / 100)) for side in (render.resolution_x, render.resolution_y)
    ]


def vertical_angle(data, size):
    """Of the view, in degrees; Blender's sensor fits the wider side unless it says which."""
    width, height = size
    fit = data.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if width >= height else "VERTICAL"
        sensor = data.sensor_width
    else:
        sensor = data.sensor_width if fit == "HORIZONTAL" else data.sensor_height
    across = sensor / (2 * data.lens)
    return math.degrees(2 * math.atan(across * height / width if fit == "HORIZONTAL" else across))


def focus_distance(camera, dof):
    """Along the camera's axis, in world units."""
    if dof.focus_object is None:
        return dof.focus_distance
    matrix = dof.focus_object.matrix_world
    if dof.focus_object.type == "ARMATURE" and dof.focus_subtarget:
        matrix = matrix @ dof.focus_object.pose.bones[dof.focus_subtarget].matrix
    forward = -axis(camera.matrix_world, 2).normalized()
    return abs(forward.dot(matrix.translation - camera.matrix_world.translation))


def write_camera(scene, camera, warnings):
    """The keys "camera" and "film"; raises Unsupported."""
    if camera is None or camera.type != "CAMERA":
        raise Unsupported("the scene has no camera; add one (Add > Camera) and make it the scene's")
    data, size = camera.data, film_size(scene)
    if data.type != "PERSP":
        raise Unsupported(
            f'the camera "{camera.name}" is not a perspective one, which vkpm has alone; set its Type to Perspective'
        )
    if data.shift_x or data.shift_y:
        warnings.append("the camera's shift is left out: vkpm looks along the camera's axis")
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        warnings.append("the pixels' aspect is left out: vkpm's are square")
    if scene.render.use_border:
        warnings.append("the render region is left out: the whole picture is rendered")
    matrix = camera.matrix_world
    origin, forward = matrix.translation, -axis(matrix, 2).normalized()
    result = {
        "origin": place(origin),
        "target": place(origin + forward),
        "up": place(axis(matrix, 1).normalized()),
        "fieldOfView": vertical_angle(data, size),
    }
    if data.dof.use_dof:
        result["aperture"] = data.lens / 1000 / (2 * data.dof.aperture_fstop)  # Blender's unit counts as a metre
        result["focusDistance"] = max(focus_distance(camera, data.dof), 1e-5)
        if data.dof.aperture_blades or data.dof.aperture_ratio != 1:
            warnings.append("the aperture's blades and ratio are left out: vkpm's lens is round")
    return {"camera": result, "film": {"size": size}}
