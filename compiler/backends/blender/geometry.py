# ---------------------------------------------------------------- geometry
IDENTITY = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))


def affine(rows):
    return np.array((*rows, (0.0, 0.0, 0.0, 1.0)))


def unit(vector):
    vector = np.asarray(vector, float)
    return vector / np.linalg.norm(vector)


#: curved disc plane
def frame(normal):
    """Two unit vectors that with the unit normal make a right-handed frame."""
    first = unit(np.cross(normal, np.eye(3)[np.abs(normal).argmin()]))
    return first, np.cross(normal, first)


#: end
def new_mesh(name, points, faces, smooth=False, materials=()):
    """`faces` is an array of corners, k per face; `materials` has one slot per face, or is empty."""
    mesh = own(bpy.data.meshes.new(short(name)))
    points, faces = np.asarray(points, np.float32), np.asarray(faces, np.int32)
    count, corners = faces.shape
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.ravel())
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, corners, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(count, corners, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(count, smooth))
    if len(materials):
        mesh.polygons.foreach_set("material_index", np.asarray(materials, np.int32))
    mesh.update(calc_edges=True)
    return mesh


#: smooth
def set_normals(mesh, normals):
    """One normal per corner, interpolated by the material."""
    attribute = mesh.attributes.new("scc_normal", "FLOAT_VECTOR", "CORNER")
    attribute.data.foreach_set("vector", np.asarray(normals, np.float32).ravel())


#: end
#: uv
def set_uvs(mesh, uvs):
    """One pair per corner, interpolated by the material."""
    attribute = mesh.attributes.new("scc_uv", "FLOAT_VECTOR", "CORNER")
    attribute.data.foreach_set("vector", np.pad(np.asarray(uvs, np.float32), ((0, 0), (0, 1))).ravel())


#: end
#: curved disc
def apparent_radius(o, center, radius):
    """In pixels; of the whole picture where the camera is inside."""
    rows = o.get("world", IDENTITY)
    radius *= max(math.hypot(*column) for column in list(zip(*rows))[:3])
    center = [sum(m * x for m, x in zip(row, (*center, 1.0))) for row in rows]
    distance = math.dist(center, CAMERA["eye"]) - radius
    if CAMERA["type"] == "ORTHO":
        distance = 1.0  # half_height is an angle in a panorama: of small ones as good as its tangent
    return min(1.0, radius / (2 * CAMERA["half_height"] * max(distance, 1e-3 * radius))) * SIZE[1]


#: end
#: cylinder cone disc torus
ASPECT = 8.0  # of a triangle; the sliver's length over its width multiplies Cycles' rounding error of a hit


def segments(o, center, radius):
    """Of a circle that is drawn right to a 250th of a pixel."""
    needed = math.pi * math.sqrt(62.5 * apparent_radius(o, center, radius))
    return min(max(2 ** math.ceil(math.log2(max(needed, 1))), 128), 1024)


def circle(n):
    """Corners of a polygon as far outside of the unit circle as its edges' middles are inside."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.stack((np.cos(angle), np.sin(angle)), 1) / math.sqrt(math.cos(math.pi / n))


def fill(corners):
    """Triangles of a convex polygon without a fan's slivers: cut every second corner off, again and again."""
    triangles, ring = [], np.asarray(corners)
    while len(ring) > 2:
        triangles.append(np.stack((ring[::2], ring[1::2], np.roll(ring[::2], -1)), 1))
        ring = ring[::2]
    return np.concatenate(triangles)


def band(n, rows):
    """Triangles between `rows` + 1 rings of n points, seen from where the points run counter-clockwise upwards."""
    low = np.arange(n * rows)
    after = low - low % n + (low + 1) % n
    return np.concatenate((np.stack((low, after, after + n), 1), np.stack((low, after + n, low + n), 1)))


#: end
#: sphere
def sphere_divisions(o):
    """So many that the outline is right to a 250th of a pixel, within reason."""
    needed = math.log(0.12 * 250 * apparent_radius(o, o["center"], o["radius"]), 4)
    #: through
    needed += 1  # rays leave from the mesh, and what they show through the ball moves more than its outline
    #: end
    return min(max(math.ceil(needed), 3), 8)


def sphere_mesh(o):
    """The unit sphere as an icosahedron, divided; the corners as far outside as the triangles' middles are inside."""
    g = (1 + math.sqrt(5)) / 2
    points = np.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
                       (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)], float) / math.sqrt(1 + g * g)
    faces = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                      (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
                      (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    for _ in range(sphere_divisions(o)):
        edges = np.sort(faces[:, ((0, 1), (1, 2), (2, 0))].reshape(-1, 2), axis=1)
        edges, index = np.unique(edges, axis=0, return_inverse=True)
        middle = points[edges].sum(axis=1)
        middle /= np.linalg.norm(middle, axis=1, keepdims=True)
        a, b, c = faces.T
        ab, bc, ca = (len(points) + index.reshape(-1, 3)).T
        points = np.concatenate((points, middle))
        faces = np.concatenate([np.stack(t, 1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    inside = np.linalg.norm(points[faces].mean(axis=1), axis=1).min()
    return new_mesh("sphere", points / math.sqrt(inside), faces, smooth=True)


def sphere_axes(o):
    return (*(o["radius"] * np.eye(3)), o["center"])


#: end
#: cylinder cone
def cylinder_cells(o):
    """Segments around and rows along, so that the sides' triangles are no slivers."""
    start, axis = np.array(o["start"]), np.subtract(o["end"], o["start"])
    length = np.linalg.norm(axis)
    n = segments(o, start + axis / 2, math.hypot(o["radius"], length / 2))
    return n, 2 ** math.ceil(math.log2(max(1.0, length * n / (2 * math.pi * o["radius"] * ASPECT))))


#: end
#: cylinder
def cylinder_mesh(o):
    """Radius 1 about the z axis from 0 to 1; the ends have corners of their own and the second material."""
    n, rows = cylinder_cells(o)
    ring, side = circle(n), band(n, rows)
    rings = [np.column_stack((ring, np.full(n, k / rows))) for k in range(rows + 1)]
    #: cap
    if o.get("caps", True):
        first = n * (rows + 1)
        ends = fill(np.arange(n)[::-1] + first), fill(np.arange(n) + first + n)
        return new_mesh("cylinder", np.concatenate(rings + [rings[0], rings[-1]]), np.concatenate((side, *ends)), True,
                        np.repeat((0, 1), (len(side), 2 * len(ends[0]))))
    #: end
    return new_mesh("open cylinder", np.concatenate(rings), side, True)


#: end
#: cone
def cone_mesh(o):
    """Radius 1 - taper z about the z axis from 0 to 1; the ends as a cylinder's, none at a sharp tip."""
    n, rows = cylinder_cells(o)
    taper, ring, side = o["taper"], circle(n), band(n, rows)
    if taper == 1.0:
        side = side[:-n]  # those that have two corners in the tip
    rings = [np.column_stack((ring * (1 - taper * k / rows), np.full(n, k / rows))) for k in range(rows + 1)]
    #: cap
    if o.get("caps", True):
        first = n * (rows + 1)
        ends = [fill(np.arange(n)[::-1] + first), fill(np.arange(n) + first + n)][:1 if taper == 1.0 else 2]
        return new_mesh("cone", np.concatenate(rings + [rings[0], rings[-1]]), np.concatenate((side, *ends)), True,
                        np.repeat((0, 1), (len(side), sum(map(len, ends)))))
    #: end
    return new_mesh("open cone", np.concatenate(rings), side, True)


#: end
#: cylinder cone
def cylinder_axes(o):
    start, axis = np.array(o["start"]), np.subtract(o["end"], o["start"])
    first, second = frame(unit(axis))
    return o["radius"] * first, o["radius"] * second, axis, start


#: end
#: torus
def torus_cells(o):
    """Segments along the circle and around the tube, of which the apparent radius is that part."""
    n = min(segments(o, o["center"], o["major"] * (1 + o["tube"])), 512)
    return n, max(min(2 ** math.ceil(math.log2(n * math.sqrt(o["tube"]))), 256), 32)


def torus_mesh(o):
    """About the z axis, its circle of radius 1; the tube is closed by a second ring of corners at its seam."""
    n, rows = torus_cells(o)
    along, around = circle(n), circle(rows)[np.arange(rows + 1) % rows] * o["tube"]
    rings = [np.column_stack((along * (1 + x), np.full(n, z))) for x, z in around]
    return new_mesh("torus", np.concatenate(rings), band(n, rows), smooth=True)


def torus_axes(o):
    axis = unit(o["axis"])
    return (*(o["major"] * np.array((*frame(axis), axis))), o["center"])


#: end
#: box
def box_mesh(o):
    (x0, y0, z0), (x1, y1, z1) = o["low"], o["high"]
    points = [(x, y, z) for z in (z0, z1) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return new_mesh(o["name"], points, ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)))


#: end
#: disc
def disc_mesh(o):
    outer, center = o["radius"], np.array(o["center"])
    n = segments(o, center, outer)
    ring = circle(n) @ np.stack(frame(unit(o["normal"])))
    #: hole
    hole = o.get("hole", 0.0)
    if hole > 0:
        rows = math.ceil((outer - hole) * n / (2 * math.pi * outer * ASPECT))
        radii = np.linspace(outer, hole, rows + 1)
        return new_mesh(o["name"], np.concatenate([center + r * ring for r in radii]), band(n, rows))
    #: end
    return new_mesh(o["name"], center + outer * ring, fill(np.arange(n)))


#: end
#: triangle
def triangle_mesh(o):
    mesh = new_mesh(o["name"], o["points"], ((0, 1, 2),))
    #: smooth
    if "normals" in o:
        set_normals(mesh, [unit(normal) for normal in o["normals"]])
    #: end
    return mesh


#: end
#: mesh
def mesh_mesh(o):
    m = MESHES[o["mesh"]]
    faces = np.reshape(m["indices"], (-1, 3))
    mesh = new_mesh(o["mesh"], np.reshape(m["points"], (-1, 3)), faces)
    #: smooth
    if "normals" in m:
        set_normals(mesh, np.reshape(m["normals"], (-1, 3))[np.ravel(m["normal_indices"])])
    #: end
    #: uv
    if "uvs" in m:
        set_uvs(mesh, np.reshape(m["uvs"], (-1, 2))[np.ravel(m["uv_indices"])])
    #: end
    return mesh


#: end
#: solid
def solid_mesh(o):
    m = dict(points=(), indices=(), normals=(), normal_indices=(), slots=())  # of what is empty
    m.update(SOLIDS[o["name"]])
    points, faces = np.reshape(m["points"], (-1, 3)), np.reshape(m["indices"], (-1, 3))
    normals = np.reshape(m["normals"], (-1, 3))[np.ravel(m["normal_indices"]).astype(int)]
    #: boolean
    if "cuts" in o:  # a Boolean interpolates attributes where it cuts, but not Blender's own normals
        mesh = new_mesh(o["name"], points, faces, False, m["slots"])
        set_normals(mesh, normals)
        return mesh
    #: end
    mesh = new_mesh(o["name"], points, faces, True, m["slots"])
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    mesh.normals_split_custom_set(normals.tolist())
    return mesh


#: end
#: plane
PLANE_SEGMENTS, PLANE_RINGS = 5, 10  # the last ring is a million times as large as the first


def world_plane(o):
    """Unit normal and offset in the world."""
    into_object = np.linalg.inv(affine(o.get("world", IDENTITY)))
    normal = np.append(unit(o["normal"]), -o["offset"]) @ into_object
    length = np.linalg.norm(normal[:3])
    return normal[:3] / length, -normal[3] / length


def plane_mesh(o):
    """Rings around the scene, each four times as large as the one inside it, so that near triangles are small and the
    far ones reach the horizon. Stands in the world."""
    normal, offset = world_plane(o)
    first, second = frame(normal)
    center = np.array(CENTER) + (offset - normal @ CENTER) * normal
    angle = 0.7 + 2 * np.pi * np.arange(PLANE_SEGMENTS) / PLANE_SEGMENTS
    spoke = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second)
    points = np.concatenate([center[None]] + [center + EXTENT * 4.0 ** k * spoke for k in range(PLANE_RINGS + 1)])
    here = np.arange(PLANE_SEGMENTS)
    after, faces = np.roll(here, -1), []
    for k in range(PLANE_RINGS):
        a, b = 1 + k * PLANE_SEGMENTS, 1 + (k + 1) * PLANE_SEGMENTS
        faces += [np.stack((a + here, b + here, b + after), 1), np.stack((a + here, b + after, a + after), 1)]
    middle = np.stack((np.zeros_like(here), 1 + here, 1 + after), 1)
    return new_mesh(o["name"], points, np.concatenate([middle] + faces))


#: end
def place(ob, rows, parent):
    """Location and scale where these are enough. A general matrix goes through the inverse of a parent's, since
    an object of its own has no place for shear."""
    linear = mathutils.Matrix(rows).to_3x3()
    if all(linear[i][j] == 0 for i in range(3) for j in range(3) if i != j):
        ob.location, ob.scale = [row[3] for row in rows], [rows[i][i] for i in range(3)]
    else:
        ob.parent, ob.matrix_parent_inverse = parent(), mathutils.Matrix((*rows, (0, 0, 0, 1)))


