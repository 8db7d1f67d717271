# ---------------------------------------------------------------- hits
# One node group per kind of surface says where the ray really hit. Position: in the world. Normal: unit, in the
# world, facing the viewer. Outward: the same, pointing to the front side. Back: 1 where the back side is seen.
# P: in the coordinates that the shape was written in.
HIT = dict(Position="Vector", Normal="Vector", Outward="Vector", Back="Float", P="Vector",
           #: uv
           UV="Vector",
           #: end
           )


#: flat
def flat_hit(o=None):
    g, _, out = new_group("flat hit", {}, HIT)
    geometry = g.add("ShaderNodeNewGeometry").outputs
    g.put(out["Position"], geometry["Position"])
    g.put(out["Normal"], geometry["Normal"])
    g.put(out["Outward"], g.v("SCALE", geometry["Normal"], front_sign(g, geometry)))
    g.put(out["Back"], geometry["Backfacing"])
    g.put(out["P"], g.add("ShaderNodeTexCoord").outputs["Object"])
    #: uv
    g.put(out["UV"], g.attribute("GEOMETRY", "scc_uv"))
    #: end
    return g.tree


#: end
#: flat smooth horizon
def front_sign(g, geometry):
    return g.f("MULTIPLY_ADD", geometry["Backfacing"], -2.0, 1.0)


#: end
#: curved smooth
def normal_to_world(g, normal):
    """By the inverse transpose; Vector Transform treats a normal as a direction in Blender 3.4."""
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return g.v("NORMALIZE", g.join(*(g.v("DOT_PRODUCT", normal, g.to_object(axis)) for axis in axes)))


#: end
#: quadric curved
def nearest_root(g, a, b, c):
    """Of a t^2 + 2 b t + c = 0, the one nearest to 0."""
    root = g.f("SQRT", g.f("MAXIMUM", g.f("SUBTRACT", g.f("MULTIPLY", b, b), g.f("MULTIPLY", a, c)), 0.0))
    sign = g.f("MULTIPLY_ADD", g.f("GREATER_THAN", b, 0.0), 2.0, -1.0)
    return g.f("MULTIPLY", g.f("DIVIDE", c, g.f("MULTIPLY_ADD", sign, root, b)), -1.0)


#: end
#: curved
def curved_hit(name, coefficients, gradient, steps=1):
    """Replaces the hit on the tessellated mesh by the root of a t^2 + 2 b t + c = 0 that is nearest to it: of a
    quadric the equation itself, of others its expansion, which takes more steps.

    The mesh stands in unit coordinates; the ray's direction is not normalised there, so t is a world length."""
    g, _, out = new_group(name + " hit", {}, HIT)
    geometry = g.add("ShaderNodeNewGeometry").outputs
    viewer = geometry["Incoming"]
    start, direction = g.add("ShaderNodeTexCoord").outputs["Object"], g.to_object(g.v("SCALE", viewer, -1.0))
    unit, t = start, None
    for _ in range(steps):
        step = nearest_root(g, *coefficients(g, unit, direction))
        unit = g.v("ADD", unit, g.v("SCALE", direction, step))
        t = g.f("ADD", t, step) if t else step
    outward = normal_to_world(g, gradient(g, unit))
    g.put(out["Position"], g.v("SUBTRACT", geometry["Position"], g.v("SCALE", viewer, t)))
    g.put(out["Normal"], g.v("SCALE", outward, g.f("SIGN", g.v("DOT_PRODUCT", outward, viewer))))
    g.put(out["Outward"], outward)
    g.put(out["Back"], geometry["Backfacing"])
    #: curved_p
    g.put(out["P"], written_point(g, unit))
    #: end
    return g.tree


#: end
#: curved_p
def written_point(g, unit):
    """From a mesh's unit coordinates to those that the shape was written in, by the object's own properties."""
    point = g.attribute("OBJECT", "scc_origin")
    for axis, scale in zip(("scc_x", "scc_y", "scc_z"), g.split(unit)):
        point = g.v("ADD", point, g.v("SCALE", g.attribute("OBJECT", axis), scale))
    return point


#: end
#: solid horizon
def by_rows(g, rows, point):
    """An affine map of a point."""
    return g.join(*(g.f("ADD", g.v("DOT_PRODUCT", point, tuple(row[:3])), row[3]) for row in rows))


#: end
#: solid
def of_member(tree, f):
    """A hit on a mesh in the world, with P as the solid's member has it."""
    tree.name = "scc hit on " + short(f["name"])
    if "member" in f:
        g = Graph(tree)
        outputs = next(n for n in tree.nodes if n.type == "GROUP_OUTPUT").inputs
        g.put(outputs["P"], by_rows(g, f["member"], outputs["Position"].links[0].from_socket))
    return tree


#: flat
def face_hit(f):
    """A face of a solid, where the mesh is hit."""
    return of_member(flat_hit(), f)


#: end
#: boolean
def part_hit(f):
    """The same of a solid that Blender makes, with the normals that the part had there."""
    return of_member(smooth_hit(), f)


#: end
#: end
#: formula
def formula_hit(f, along, gradient):
    """Replaces the hit on a solid's mesh by one on its formula: `along(g, start, way)` gives the place on the ray, a
    length in the world. The formula has coordinates of its own, `frame` of the world."""
    g, _, out = new_group("hit on " + f["name"], {}, HIT)
    geometry = g.add("ShaderNodeNewGeometry").outputs
    viewer, seen, rows = geometry["Incoming"], geometry["Position"], f["frame"]
    way = g.join(*(g.v("DOT_PRODUCT", viewer, tuple(-x for x in row[:3])) for row in rows))
    start = by_rows(g, rows, seen)
    t = along(g, start, way)
    normal = gradient(g, g.v("ADD", start, g.v("SCALE", way, t)))
    if f.get("inverted"):
        normal = g.v("SCALE", normal, -1.0)
    columns = [tuple(row[k] for row in rows) for k in range(3)]
    outward = g.v("NORMALIZE", g.join(*(g.v("DOT_PRODUCT", normal, column) for column in columns)))
    position = g.v("SUBTRACT", seen, g.v("SCALE", viewer, t))
    g.put(out["Position"], position)
    g.put(out["Normal"], g.v("SCALE", outward, g.f("SIGN", g.v("DOT_PRODUCT", outward, viewer))))
    g.put(out["Outward"], outward)
    g.put(out["Back"], geometry["Backfacing"])
    g.put(out["P"], by_rows(g, f["member"], position) if "member" in f else position)
    return g.tree


#: end
#: field ring
def newton_hit(f, field):
    """By Newton's steps from the mesh, no farther than `reach`. `field(g, p)` gives the value and the gradient."""
    def along(g, start, way):
        t, p = 0.0, start
        for _ in range(3):
            value, gradient = field(g, p)
            step = g.f("DIVIDE", value, g.v("DOT_PRODUCT", gradient, way))
            t = g.f("MAXIMUM", g.f("MINIMUM", g.f("SUBTRACT", t, step), f["reach"]), -f["reach"])
            p = g.v("ADD", start, g.v("SCALE", way, t))
        return t

    return formula_hit(f, along, lambda g, p: field(g, p)[1])


#: end
#: field
@functools.lru_cache(maxsize=None)
def field_group(name):
    g, i, out = new_group(name, dict(p="Vector"), dict(Value="Float", Gradient="Vector"))
    value, *slopes = FIELDS[name](g, g.split(i["p"]))
    g.put(out["Value"], g.f("ADD", value, 0.0))
    g.put(out["Gradient"], g.join(*slopes))
    return g.tree


def field_hit(f):
    def field(g, p):
        group = g.group(field_group(f["field"]), p=p)
        return group["Value"], group["Gradient"]

    return newton_hit(f, field)


#: end
#: ring
def ring_hit(f):
    """A tube around a circle about the z axis."""
    circle, tube = f["radius"]

    def field(g, p):
        across = g.v("MULTIPLY", p, (1.0, 1.0, 0.0))
        from_circle = g.v("SUBTRACT", p, g.v("SCALE", g.v("NORMALIZE", across), circle))
        squared = g.v("DOT_PRODUCT", from_circle, from_circle)
        return g.f("MULTIPLY", g.f("SUBTRACT", squared, tube * tube), 0.5), from_circle

    return newton_hit(f, field)


#: end
#: ball
def ball_hit(f):
    radius = f["radius"][0]

    def coefficients(g, p, d):
        return (g.v("DOT_PRODUCT", d, d), g.v("DOT_PRODUCT", p, d),
                g.f("SUBTRACT", g.v("DOT_PRODUCT", p, p), radius * radius))

    return formula_hit(f, lambda g, p, d: nearest_root(g, *coefficients(g, p, d)), lambda g, p: p)


#: end
#: round
def round_hit(f):
    """About the z axis."""
    at_origin, slope = f["radius"]

    def across(g, vector):
        return g.v("MULTIPLY", vector, (1.0, 1.0, 0.0))

    def radius(g, p):
        return g.f("MULTIPLY_ADD", g.split(p).z, slope, at_origin)

    def coefficients(g, p, d):
        r, growth = radius(g, p), g.f("MULTIPLY", g.split(d).z, slope)
        p, d = across(g, p), across(g, d)
        return (g.f("SUBTRACT", g.v("DOT_PRODUCT", d, d), g.f("MULTIPLY", growth, growth)),
                g.f("SUBTRACT", g.v("DOT_PRODUCT", p, d), g.f("MULTIPLY", r, growth)),
                g.f("SUBTRACT", g.v("DOT_PRODUCT", p, p), g.f("MULTIPLY", r, r)))

    def gradient(g, p):
        return g.v("SUBTRACT", across(g, p), g.join(0.0, 0.0, g.f("MULTIPLY", radius(g, p), slope)))

    return formula_hit(f, lambda g, p, d: nearest_root(g, *coefficients(g, p, d)), gradient)


#: end
#: any_quadric
def quadric_hit(f):
    """Where squares . (x^2, y^2, z^2) + products . (x y, y z, z x) + linear . p + constant is 0."""
    products = f["products"]

    def half_slope(g, p):
        """Half the gradient of the terms of second degree."""
        x, y, z = g.split(p)
        mixed = g.join(g.f("MULTIPLY_ADD", y, products[0], g.f("MULTIPLY", z, products[2])),
                       g.f("MULTIPLY_ADD", x, products[0], g.f("MULTIPLY", z, products[1])),
                       g.f("MULTIPLY_ADD", y, products[1], g.f("MULTIPLY", x, products[2])))
        return g.v("ADD", g.v("MULTIPLY", p, f["squares"]), g.v("SCALE", mixed, 0.5))

    half_linear = tuple(x / 2 for x in f["linear"])

    def gradient(g, p):
        return g.v("ADD", half_slope(g, p), half_linear)

    def coefficients(g, p, d):
        slope = half_slope(g, p)
        value = g.f("ADD", g.v("DOT_PRODUCT", g.v("ADD", slope, f["linear"]), p), f["constant"])
        return (g.v("DOT_PRODUCT", half_slope(g, d), d),
                g.v("DOT_PRODUCT", g.v("ADD", slope, half_linear), d), value)

    return formula_hit(f, lambda g, p, d: nearest_root(g, *coefficients(g, p, d)), gradient)


#: end
#: sphere
def sphere_hit(o=None):
    def coefficients(g, p, d):
        return (g.v("DOT_PRODUCT", d, d), g.v("DOT_PRODUCT", p, d),
                g.f("SUBTRACT", g.v("DOT_PRODUCT", p, p), 1.0))

    return curved_hit("sphere", coefficients, lambda g, unit: unit)


#: end
#: cylinder
def cylinder_hit(o=None):
    def across(g, vector):
        return g.v("MULTIPLY", vector, (1.0, 1.0, 0.0))

    def coefficients(g, p, d):
        p, d = across(g, p), across(g, d)
        return (g.v("DOT_PRODUCT", d, d), g.v("DOT_PRODUCT", p, d),
                g.f("SUBTRACT", g.v("DOT_PRODUCT", p, p), 1.0))

    return curved_hit("cylinder", coefficients, across)


#: end
#: cone
def cone_hit(o=None):
    def across(g, vector):
        return g.v("MULTIPLY", vector, (1.0, 1.0, 0.0))

    def radius(g, p):
        """Of the cone at the height of p, and how much it loses for each unit of height."""
        taper = g.attribute("OBJECT", "scc_taper", "Fac")
        return g.f("SUBTRACT", 1.0, g.f("MULTIPLY", taper, g.split(p).z)), taper

    def coefficients(g, p, d):
        r, taper = radius(g, p)
        loss = g.f("MULTIPLY", taper, g.split(d).z)
        p, d = across(g, p), across(g, d)
        return (g.f("SUBTRACT", g.v("DOT_PRODUCT", d, d), g.f("MULTIPLY", loss, loss)),
                g.f("MULTIPLY_ADD", r, loss, g.v("DOT_PRODUCT", p, d)),
                g.f("SUBTRACT", g.v("DOT_PRODUCT", p, p), g.f("MULTIPLY", r, r)))

    def gradient(g, unit):
        r, taper = radius(g, unit)
        return g.v("ADD", across(g, unit), g.join(0.0, 0.0, g.f("MULTIPLY", r, taper)))

    return curved_hit("cone", coefficients, gradient)


#: end
#: torus
def torus_hit(o=None):
    """About the z axis, its circle of radius 1: (r - 1)^2 + z^2 = tube^2 with r the distance from the axis."""
    def across(g, vector):
        return g.v("MULTIPLY", vector, (1.0, 1.0, 0.0))

    def coefficients(g, p, d):
        tube, z, climb = g.attribute("OBJECT", "scc_tube", "Fac"), g.split(p).z, g.split(d).z
        p, d = across(g, p), across(g, d)
        r = g.v("LENGTH", p)
        off, slope = g.f("SUBTRACT", r, 1.0), g.f("DIVIDE", g.v("DOT_PRODUCT", p, d), r)
        bend = g.f("DIVIDE", g.f("SUBTRACT", g.v("DOT_PRODUCT", d, d), g.f("MULTIPLY", slope, slope)), r)
        a = g.f("MULTIPLY_ADD", off, bend, g.f("MULTIPLY_ADD", slope, slope, g.f("MULTIPLY", climb, climb)))
        b = g.f("MULTIPLY_ADD", off, slope, g.f("MULTIPLY", z, climb))
        return a, b, g.f("MULTIPLY_ADD", off, off, g.f("SUBTRACT", g.f("MULTIPLY", z, z), g.f("MULTIPLY", tube, tube)))

    def gradient(g, unit):
        inverse = g.f("DIVIDE", 1.0, g.v("LENGTH", across(g, unit)))
        return g.v("SUBTRACT", unit, g.v("SCALE", across(g, unit), inverse))

    return curved_hit("torus", coefficients, gradient, steps=3)


#: end
#: cap
def cap_hit(o=None):
    """The flat ends of a cylinder or cone, whose mesh stands in unit coordinates."""
    tree = flat_hit()
    tree.name = "scc cap hit"
    #: curved_p
    g = Graph(tree)
    p = next(n for n in tree.nodes if n.type == "GROUP_OUTPUT").inputs["P"]
    g.put(p, written_point(g, p.links[0].from_socket))
    #: end
    return tree


#: end
#: smooth
def smooth_hit(o=None):
    """A flat mesh that is shaded with normals interpolated from its corners."""
    g, _, out = new_group("smooth hit", {}, HIT)
    geometry = g.add("ShaderNodeNewGeometry").outputs
    normal = normal_to_world(g, g.attribute("GEOMETRY", "scc_normal"))
    facing = g.f("SUBTRACT", 1.0, g.f("MULTIPLY", 2.0, g.f("LESS_THAN", g.v("DOT_PRODUCT", normal, geometry["Incoming"]), 0.0)))
    g.put(out["Position"], geometry["Position"])
    g.put(out["Normal"], g.v("SCALE", normal, facing))
    g.put(out["Outward"], g.v("SCALE", geometry["Normal"], front_sign(g, geometry)))
    g.put(out["Back"], geometry["Backfacing"])
    g.put(out["P"], g.add("ShaderNodeTexCoord").outputs["Object"])
    #: uv
    g.put(out["UV"], g.attribute("GEOMETRY", "scc_uv"))
    #: end
    return g.tree


#: end
#: horizon
def plane_hit(o):
    """An unbounded plane with a pattern.

    A camera ray's direction in 32 bits puts the hit wrong by whole cells of a pattern near the horizon. There the
    pattern's point is computed from the indices of the pixel instead: it is a quotient of functions that are linear
    in column and row, with coefficients cut into pieces so short that the products and the sums are exact."""
    g, _, out = new_group("hit on " + o["name"], {}, HIT)
    geometry = g.add("ShaderNodeNewGeometry").outputs
    g.put(out["Normal"], geometry["Normal"])
    g.put(out["Outward"], g.v("SCALE", geometry["Normal"], front_sign(g, geometry)))
    g.put(out["Back"], geometry["Backfacing"])
    index = g.v("FLOOR", g.v("MULTIPLY", g.add("ShaderNodeTexCoord").outputs["Window"], (*SIZE, 0.0)))
    column, row, _ = g.split(index)
    numerator, denominator = plane_by_pixel(o)
    exact = g.v("DIVIDE", by_pixel(g, numerator, column, row), by_pixel(g, denominator, column, row))
    seen = g.f("LESS_THAN", g.add("ShaderNodeLightPath").outputs["Ray Depth"], 0.5)
    position = choose(g, seen, geometry["Position"], exact)
    g.put(out["Position"], position)
    if "world" in o:
        position = by_rows(g, np.linalg.inv(affine(o["world"]))[:3].tolist(), position)
    g.put(out["P"], position)
    return g.tree


def plane_by_pixel(o):
    """Position = numerator(column, row) / denominator(column, row); each 3 x 3, a row per coordinate: (1, column, row)."""
    eye, right, up, back = (np.array(CAMERA[k]) for k in ("eye", "right", "up", "back"))
    normal, offset = world_plane(o)
    half, (shift_x, shift_y), (width, height) = CAMERA["half_height"], window_shift(), SIZE
    # In units of half the height: x = (2 column + 1 - width) / height + 2 shift; rows count from the bottom.
    x = np.array(((1 - width) / height + 2 * shift_x, 2 / height, 0.0))
    y = np.array(((1 - height) / height + 2 * shift_y, 0.0, 2 / height))
    on_window = half * (np.outer(right, x) + np.outer(up, y))
    constant = np.array((1.0, 0.0, 0.0))
    if CAMERA["type"] == "PERSP":
        direction = on_window - np.outer(back, constant)
        below = normal @ direction
        above = np.outer(eye, below) + (offset - normal @ eye) * direction
    else:
        origin, direction = np.outer(eye, constant) + on_window, -back
        below = constant * (normal @ direction)
        above = origin * (normal @ direction) + np.outer(direction, offset * constant - normal @ origin)
    return above, np.tile(below, (3, 1))


def by_pixel(g, coefficients, column, row):
    """Three linear functions of the pixel's indices, exact until the last few additions."""
    index_bits = max(SIZE).bit_length()
    bits = 22 - index_bits
    largest = np.abs(coefficients * (2.0 ** -index_bits, 1, 1)).max(axis=1)
    unit = np.where(largest > 0, 2.0 ** np.ceil(np.log2(np.where(largest > 0, largest, 1))), 1.0)
    rest, total = coefficients, None
    for _ in range(math.ceil(48 / bits)):
        unit = unit / 2.0 ** bits
        piece = np.rint(rest / unit[:, None])
        rest = rest - piece * unit[:, None]
        constant, per_column, per_row = (tuple(map(float, piece[:, k])) for k in range(3))
        part = g.v("MULTIPLY_ADD", g.join(row, row, row), per_row, constant)
        part = g.v("MULTIPLY_ADD", g.join(column, column, column), per_column, part)
        scale = tuple(map(float, unit))
        total = g.v("MULTIPLY", part, scale) if total is None else g.v("MULTIPLY_ADD", part, scale, total)
    return total


#: end
#: two_sided horizon
def choose(g, truth, if_not, if_so):
    """Between two vectors or colours."""
    node = g.add("ShaderNodeMixRGB")
    for socket, value in zip(node.inputs, (truth, if_not, if_so)):
        g.put(socket, value)
    return node.outputs[0]


#: end
