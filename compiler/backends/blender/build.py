# ---------------------------------------------------------------- building
TAG = "scc_owner"


def own(block):
    """Marks a datablock as this script's, so that a later run replaces it and nothing else."""
    block[TAG] = NAME
    return block


def short(name):
    """Blender cuts names after 63 bytes; a long one keeps its beginning and gets a sum of all of it."""
    if len(name.encode()) <= 59:  # Blender may append .001
        return name
    digest = hashlib.sha256(name.encode()).hexdigest()[:8]
    return name.encode()[:50].decode(errors="ignore") + "~" + digest


def fresh_scene():
    scene = bpy.data.scenes.new("scc")
    for old in [s for s in bpy.data.scenes if s.get(TAG) == NAME]:
        bpy.data.scenes.remove(old)
    for pool in (bpy.data.objects, bpy.data.meshes, bpy.data.lights, bpy.data.cameras, bpy.data.materials,
                 bpy.data.node_groups, bpy.data.worlds, bpy.data.collections,
                 #: image
                 bpy.data.images,
                 #: end
                 ):
        for block in [b for b in pool if b.get(TAG) == NAME]:
            pool.remove(block)
    scene.name = short(NAME)
    return own(scene)


def new_collection(scene, name):
    collection = own(bpy.data.collections.new(short(name)))
    scene.collection.children.link(collection)
    return collection


def new_object(collection, name, data):
    ob = own(bpy.data.objects.new(short(name), data))
    collection.objects.link(ob)
    return ob


#: image
@functools.lru_cache(maxsize=None)
def image_data(name):
    """Floats of linear light, so that Cycles blends what we blend."""
    entry = IMAGES[name]
    width, height = entry["size"]
    light = np.asarray(entry["light_of_code"])[entry["texels"]] if "light_of_code" in entry else entry["texels"]
    pixels = np.ones((width * height, 4), np.float32)
    pixels[:, :3] = np.reshape(light, (width * height, -1))
    image = own(bpy.data.images.new(short(name), width, height, alpha=True, float_buffer=True))
    image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


#: end
#: function
@functools.lru_cache(maxsize=None)
def function_group(name):
    build, reads = FUNCTIONS[name]
    results = build.__annotations__["return"]
    g, i, out = new_group(name, {key: "Vector" for key in reads}, dict(Result=results))
    value = build(g, *(g.split(i[key]) for key in reads))
    g.put(out["Result"], g.join(*value) if results == "Color" else g.f("ADD", value, 0.0))
    return g.tree


#: end
BLACK = (0.0, 0.0, 0.0)
DEFAULTS = dict(
    #: specular
    specular=BLACK, shininess=32.0,
    #: end
    #: emission
    emission=BLACK,
    #: end
    #: mirror
    reflect=BLACK,
    #: end
    #: bump
    bump=BLACK,
    #: end
    #: through
    transmit=BLACK, ior=1.0, fresnel=0.0,
    #: end
)


def one_side(g, name, hit):
    """The fields of a material, those that vary as sockets."""
    fields = dict(DEFAULTS, **MATERIALS[name])
    #: function
    for key, value in fields.items():
        if isinstance(value, str):
            outputs = dict(p="P", world="Position", n="Outward", uv="UV")
            points = {read: hit[outputs[read]] for read in FUNCTIONS[value][1]}
            fields[key] = g.group(function_group(value), **points)["Result"]
    #: end
    return fields


class Materials:
    """Made when first used: one per kind of surface and pair of sides."""

    def __init__(self, surface):
        self.surface, self.hits, self.made = surface, {}, {}

    def get(self, kind, o):
        front = o.get("material") or o["front"]
        back = o.get("back", front)
        single = o["name"] if kind in SINGLE else ""
        key = kind, single, front, back
        #: through
        key = *key, o.get("outside", 1.0)
        #: end
        if key not in self.made:
            self.made[key] = self.make(kind, single, front, back, o)
        return self.made[key]

    def make(self, kind, single, front, back, o):
        if (kind, single) not in self.hits:
            self.hits[kind, single] = HITS[kind](o)
        name = front if front == back else f"{front} | {back}"
        material = own(bpy.data.materials.new(short(name)))
        material.use_nodes, material.cycles.sample_as_light = True, False
        material.node_tree.nodes.clear()
        g = Graph(material.node_tree)
        hit = g.group(self.hits[kind, single])
        sides = [one_side(g, side, hit) for side in dict.fromkeys((front, back))]
        #: through
        for fields in sides:
            fields["ior"] /= o.get("outside", 1.0)
        #: end
        g.put(g.add("ShaderNodeOutputMaterial").inputs["Surface"], self.surface(g, sides, hit))
        return material


class Shape:
    """How a shape becomes a mesh. `kinds`: of its surfaces, one material slot each. `shared`: objects with the same
    key and materials share a mesh, which `axes` (x, y, z, origin) brings to where the shape was written."""

    def __init__(self, mesh, kinds=lambda o: ("flat",), shared=lambda o: o["name"], axes=None):
        self.mesh, self.kinds, self.shared, self.axes = mesh, kinds, shared, axes

    def surfaces(self, o):
        """The kinds with what has their material."""
        #: solid
        if "faces" in o:
            common = {key: o[key] for key in ("outside",) if key in o}
            return [(f["kind"], dict(f, **common, name=f"{o['name']} {k}")) for k, f in enumerate(o["faces"])]
        #: end
        return [(kind, o) for kind in self.kinds(o)]


#: smooth
def flat_or_smooth(o):
    return ("smooth" if "normals" in (MESHES[o["mesh"]] if "mesh" in o else o) else "flat",)


#: end
#: cylinder cone
def side_and_caps(o):
    #: cap
    if o.get("caps", True):
        return o["type"], "cap"
    #: end
    return (o["type"],)


#: end
#: plane
def plane_kinds(o):
    #: horizon
    fields = [v for side in ("material", "front", "back") if side in o for v in MATERIALS[o[side]].values()]
    if any(isinstance(v, str) and {"p", "world"} & set(FUNCTIONS[v][1]) for v in fields):
        return ("plane",)
    #: end
    return ("flat",)


#: end
# kinds with numbers of one object in their nodes
SINGLE = ("plane", "face", "part", "ball", "round", "ring", "quadric", "field")
HITS = {
    #: solid
    #: flat
    "face": face_hit,
    #: end
    #: boolean
    "part": part_hit,
    #: end
    #: end
    #: ball
    "ball": ball_hit,
    #: end
    #: round
    "round": round_hit,
    #: end
    #: ring
    "ring": ring_hit,
    #: end
    #: any_quadric
    "quadric": quadric_hit,
    #: end
    #: field
    "field": field_hit,
    #: end
    #: flat
    "flat": flat_hit,
    #: end
    #: sphere
    "sphere": sphere_hit,
    #: end
    #: cylinder
    "cylinder": cylinder_hit,
    #: end
    #: cone
    "cone": cone_hit,
    #: end
    #: torus
    "torus": torus_hit,
    #: end
    #: cap
    "cap": cap_hit,
    #: end
    #: smooth
    "smooth": smooth_hit,
    #: end
    #: horizon
    "plane": plane_hit,
    #: end
}
SHAPES = {
    #: sphere
    "sphere": Shape(sphere_mesh, lambda o: ("sphere",), sphere_divisions, sphere_axes),
    #: end
    #: box
    "box": Shape(box_mesh),
    #: end
    #: plane
    "plane": Shape(plane_mesh, plane_kinds),
    #: end
    #: cylinder
    "cylinder": Shape(cylinder_mesh, side_and_caps, lambda o: (o.get("caps", True), *cylinder_cells(o)),
                      cylinder_axes),
    #: end
    #: cone
    "cone": Shape(cone_mesh, side_and_caps, lambda o: (o.get("caps", True), o["taper"], *cylinder_cells(o)),
                  cylinder_axes),
    #: end
    #: torus
    "torus": Shape(torus_mesh, lambda o: ("torus",), lambda o: (o["tube"], *torus_cells(o)), torus_axes),
    #: end
    #: disc
    "disc": Shape(disc_mesh),
    #: end
    #: triangle
    "triangle": Shape(triangle_mesh,
                      #: smooth
                      flat_or_smooth,
                      #: end
                      ),
    #: end
    #: solid
    "solid": Shape(solid_mesh),
    #: end
    #: mesh
    "mesh": Shape(mesh_mesh,
                  #: smooth
                  flat_or_smooth,
                  #: end
                  shared=lambda o: o["mesh"]),
    #: end
}


def add_objects(collection, materials):
    meshes, empties = {}, []

    def parent():
        if not empties:
            empties.append(new_object(collection, NAME + " origin", None))
        return empties[0]

    def add(o):
        shape = SHAPES[o["type"]]
        slots = tuple(materials.get(kind, surface) for kind, surface in shape.surfaces(o))
        key = (o["type"], shape.shared(o), *slots)
        if key not in meshes:
            meshes[key] = shape.mesh(o)
            for material in slots:
                meshes[key].materials.append(material)
        ob = new_object(collection, o["name"], meshes[key])
        world = affine(IDENTITY if o["type"] == "plane" else o.get("world", IDENTITY))
        #: curved
        if shape.axes:
            axes = np.column_stack(shape.axes(o))
            world = world @ affine(axes)
            #: cone
            if "taper" in o:
                ob["scc_taper"] = o["taper"]
            #: end
            #: torus
            if "tube" in o:
                ob["scc_tube"] = o["tube"]
            #: end
            #: curved_p
            for name, vector in zip(("scc_x", "scc_y", "scc_z", "scc_origin"), axes.T):
                ob[name] = tuple(map(float, vector))
            #: end
        #: end
        place(ob, world[:3].tolist(), parent)
        #: boolean
        for operation, part in o.get("cuts", ()):
            cutter = add(part)
            cutter.hide_render = True
            for material in cutter.data.materials:  # its faces have this object's first one otherwise
                ob.data.materials.append(material)
            modifier = ob.modifiers.new(short(part["name"]), "BOOLEAN")
            modifier.operation, modifier.solver, modifier.object = operation, "EXACT", cutter
        return ob
        #: end

    for o in OBJECTS:
        add(o)


#: window
def window_shift():
    """In heights of the picture."""
    x, y = CAMERA["shift"]
    #: corner
    x, y = x - SAMPLES_ACROSS / (2 * SIZE[1]), y - SAMPLES_ACROSS / (2 * SIZE[1])
    #: end
    return x, y


#: end
#: panorama
def panorama_corner():
    """The longitude and the latitude at the picture's lower left corner."""
    x = y = 1.0
    #: corner
    x, y = x + SAMPLES_ACROSS / SIZE[0], y + SAMPLES_ACROSS / SIZE[1]
    #: end
    return -x * CAMERA["half_width"], -y * CAMERA["half_height"]


#: end
#: lens
def add_lens(data):
    """Cycles takes the radius from the focal length, in mm, and the f-number, which is no less than 0.01."""
    radius = CAMERA["lens_radius"]
    larger = max(1.0, 2e3 * radius / data.lens)
    data.sensor_height *= larger
    data.lens *= larger
    data.dof.use_dof, data.dof.focus_distance = True, CAMERA["focus"]
    data.dof.aperture_fstop = data.lens / (2e3 * radius)


#: end
def add_camera(scene, collection):
    data = own(bpy.data.cameras.new("camera"))
    ob = new_object(collection, "camera", data)
    columns = [(*CAMERA[key], float(key == "eye")) for key in ("right", "up", "back", "eye")]
    ob.matrix_world = mathutils.Matrix(columns).transposed()
    data.type, data.sensor_fit = CAMERA["type"], "VERTICAL"
    #: window
    if data.type == "PERSP":
        data.angle_y = 2 * math.atan(CAMERA["half_height"])
    else:
        data.ortho_scale = 2 * CAMERA["half_height"]
    data.shift_x, data.shift_y = window_shift()
    #: end
    #: panorama
    data.cycles.panorama_type = "EQUIRECTANGULAR"
    (west, south), (width, height) = panorama_corner(), (2 * CAMERA["half_width"], 2 * CAMERA["half_height"])
    data.cycles.longitude_min, data.cycles.longitude_max = west, west + width
    data.cycles.latitude_min, data.cycles.latitude_max = south, south + height
    #: end
    #: lens
    add_lens(data)
    #: end
    data.clip_start, data.clip_end = max(1e-6, EXTENT * 1e-5), EXTENT * 4e6
    scene.camera = ob


#: light
#: point
def lamp_graph(lamp):
    """The lamp's nodes, and the distance to it."""
    lamp.use_nodes = True
    g = Graph(lamp.node_tree)
    return g, g.add("ShaderNodeLightPath").outputs["Ray Length"]


#: end
def add_lamps(scene, set_up):
    """One collection each, so that a view layer can leave the others out."""
    made = {}
    for name, light in LIGHTS.items():
        collection = made[name] = new_collection(scene, f"{NAME} {name}")
        lamp = own(bpy.data.lights.new(short(name), light["type"]))
        ob = new_object(collection, name, lamp)
        #: point
        if light["type"] == "POINT":
            ob.location = light["position"]
        #: end
        #: spot
        if "axis" in light:
            ob.rotation_euler = (-mathutils.Vector(light["axis"])).to_track_quat("Z", "Y").to_euler()
        #: end
        #: directional
        if light["type"] == "SUN":
            ob.rotation_euler = mathutils.Vector(light["to_light"]).to_track_quat("Z", "Y").to_euler()
            lamp.angle = 0.0
        #: end
        lamp.cycles.cast_shadow = SHADOWS
        set_up(lamp, light)
    return made


#: end
def add_world(scene):
    world = scene.world = own(bpy.data.worlds.new(short(NAME)))
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*BACKGROUND, 1.0)
    return world


def build(look, samples):
    scene = fresh_scene()
    exact = look == "exact"
    geometry = new_collection(scene, NAME + " geometry")
    add_objects(geometry, Materials(exact_surface if exact else artist_surface))
    add_camera(scene, new_collection(scene, NAME + " camera"))
    world, lamps = add_world(scene), {}
    #: light
    lamps = add_lamps(scene, exact_lamp if exact else artist_lamp)
    #: end
    render, image = scene.render, scene.render.image_settings
    render.engine, scene.cycles.device, scene.cycles.use_denoising = "CYCLES", "CPU", False
    render.resolution_x, render.resolution_y, render.resolution_percentage = *SIZE, 100
    scene.view_settings.view_transform = "Standard"
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    if exact:
        exact_world(world)
        exact_settings(scene, lamps)
        #: lens
        scene.cycles.samples = samples
        #: end
    else:
        artist_settings(scene, samples)
    return scene


