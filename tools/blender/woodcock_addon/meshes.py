# SPDX-License-Identifier: Apache-2.0
"""Meshes as PLY files, and what shape they are."""
import struct


def write_ply(mesh, file, with_uvs):
    """The triangles of a Blender mesh, binary; corners stay apart where they have texture
    coordinates."""
    mesh.calc_loop_triangles()
    layer = mesh.uv_layers.active if with_uvs else None
    vertices, faces = [], []
    if layer:
        for triangle in mesh.loop_triangles:
            faces.append(tuple(range(len(vertices), len(vertices) + 3)))
            for vertex, loop in zip(triangle.vertices, triangle.loops):
                vertices.append((*mesh.vertices[vertex].co, *layer.data[loop].uv))
    else:
        vertices = [tuple(v.co) for v in mesh.vertices]
        faces = [tuple(t.vertices) for t in mesh.loop_triangles]
    names = ["x", "y", "z"] + (["u", "v"] if layer else [])
    header = ["ply", "format binary_little_endian 1.0", "element vertex %d" % len(vertices)]
    header += ["property float " + name for name in names]
    header += ["element face %d" % len(faces), "property list uchar int vertex_indices",
               "end_header"]
    vertex = struct.Struct("<%df" % len(names))
    with open(file, "wb") as out:
        out.write(("\n".join(header) + "\n").encode())
        out.write(b"".join(vertex.pack(*v) for v in vertices))
        out.write(b"".join(struct.pack("<B3i", 3, *f) for f in faces))


def box_of(mesh):
    """(lower, upper) of a mesh that is a box along its own axes; else None."""
    points = {tuple(round(x, 6) for x in v.co) for v in mesh.vertices}
    if len(mesh.vertices) != 8 or len(points) != 8 or len(mesh.polygons) not in (6, 12):
        return None
    lower = [min(p[i] for p in points) for i in range(3)]
    upper = [max(p[i] for p in points) for i in range(3)]
    corners = {(x, y, z) for x in (lower[0], upper[0]) for y in (lower[1], upper[1])
               for z in (lower[2], upper[2])}
    return (lower, upper) if corners == points else None
