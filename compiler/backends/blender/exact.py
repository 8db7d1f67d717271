# ---------------------------------------------------------------- exact look
# Each view layer follows the paths of one kind (so many mirrors, or ways through surfaces) and lights them by one light, whose
# constants are the layer's properties; the compositor adds the layers. Toon's lobe is constant, so that the material
# computes the whole of the lecture's formula and the lamp only says whether the light is seen.
GAIN = 1024.0  # Cycles drops closures below 1e-5: materials are so much brighter, lamps so much dimmer


def field_inputs():
    return dict(Ambient="Color", Diffuse="Color", Position="Vector", Normal="Vector",
                #: emission
                Emission="Color",
                #: end
                #: specular
                Specular="Color", Shininess="Float",
                #: end
                #: mirror
                Reflect="Color",
                #: end
                #: through
                Transmit="Color", Ior="Float", Fresnel="Float", Back="Float",
                #: end
                )


@functools.lru_cache(maxsize=None)
def phong_group():
    g, i, out = new_group("phong", field_inputs(), dict(Shader="Shader"))
    normal = i["Normal"]
    depth, bounce = g.add("ShaderNodeLightPath").outputs["Ray Depth"], g.layer("scc_bounce", "Fac")
    now = g.f("COMPARE", depth, bounce, 0.25)  # nothing is lit before, nor where Cycles goes on after
    glow = g.v("MULTIPLY", i["Ambient"], AMBIENT)
    #: emission
    glow = g.v("ADD", glow, i["Emission"])
    #: end
    emission = g.add("ShaderNodeEmission")
    g.put(emission.inputs["Color"], g.v("SCALE", glow, g.f("MULTIPLY", now, g.layer("scc_glow", "Fac"))))
    shader = emission.outputs[0]
    #: light
    to_light = g.layer("scc_light")
    gain = g.f("MULTIPLY", now, GAIN)
    #: point
    to_light = g.v("SUBTRACT", to_light, g.v("SCALE", i["Position"], g.layer("scc_w", "Fac")))
    #: attenuation
    d, k = g.v("LENGTH", to_light), g.split(g.layer("scc_attenuation"))
    gain = g.f("DIVIDE", gain, g.f("MULTIPLY_ADD", g.f("MULTIPLY_ADD", k.z, d, k.y), d, k.x))
    #: end
    to_light = g.v("NORMALIZE", to_light)
    #: end
    #: spot
    off_axis = g.v("DOT_PRODUCT", to_light, g.layer("scc_axis"))  # 0 for other lights
    outer, sharpness, exponent = g.split(g.layer("scc_cone"))
    across = g.f("MULTIPLY", g.f("SUBTRACT", off_axis, outer), sharpness)
    across = g.f("MINIMUM", g.f("MAXIMUM", across, 0.0), 1.0)
    step = g.f("MULTIPLY", g.f("MULTIPLY", across, across), g.f("MULTIPLY_ADD", across, -2.0, 3.0))
    gain = g.f("MULTIPLY", gain, g.f("MULTIPLY", step, g.f("POWER", g.f("MAXIMUM", off_axis, 1e-30), exponent)))
    #: end
    cosine = g.v("DOT_PRODUCT", normal, to_light)
    light = g.v("SCALE", g.v("MULTIPLY", g.layer("scc_diffuse"), i["Diffuse"]), cosine)
    #: specular
    viewer = g.add("ShaderNodeNewGeometry").outputs["Incoming"]
    halfway = g.v("NORMALIZE", g.v("ADD", to_light, viewer))
    lobe = g.f("POWER", g.f("MAXIMUM", g.v("DOT_PRODUCT", normal, halfway), 0.0), i["Shininess"])
    light = g.v("ADD", light, g.v("SCALE", g.v("MULTIPLY", g.layer("scc_specular"), i["Specular"]), lobe))
    #: end
    toon = g.add("ShaderNodeBsdfToon", component="DIFFUSE")
    toon.inputs["Size"].default_value, toon.inputs["Smooth"].default_value = 1.0, 0.0
    light = g.v("SCALE", light, g.f("MULTIPLY", gain, g.f("GREATER_THAN", cosine, 0.0)))
    g.put(toon.inputs["Color"], light)
    shader = g.sum(toon.outputs[0], shader)
    #: smooth
    shader = g.sum(shader, light_from_below(g, light, to_light))
    #: end
    #: end
    #: mirror
    #: opaque
    goes_on = mirror(g, i["Reflect"], normal)
    #: end
    #: through
    goes_on = way_on(g, i, normal, depth)
    #: end
    shader = g.mix(g.f("LESS_THAN", depth, g.f("SUBTRACT", bounce, 0.5)), shader, goes_on)
    #: end
    #: through
    shadow = g.add("ShaderNodeBsdfTransparent")
    g.put(shadow.inputs["Color"], i["Transmit"])
    shader = g.mix(g.add("ShaderNodeLightPath").outputs["Is Shadow Ray"], shader, shadow.outputs[0])
    #: end
    g.put(out["Shader"], shader)
    return g.tree


#: mirror
def mirror(g, color, normal):
    glossy = g.add("ShaderNodeBsdfGlossy", distribution="SHARP")
    glossy.inputs["Roughness"].default_value = 0.0
    g.put(glossy.inputs["Color"], color)
    g.put(glossy.inputs["Normal"], normal)
    return glossy.outputs[0]


#: end
#: through
def way_on(g, i, normal, depth):
    """Through the surface or mirrored, as the layer's path says for this depth: 1 or 0 is the bit of `scc_path`. What is
    totally reflected goes the way through. Snell's law is Cycles' own, which takes 1 / IOR on the back side."""
    ior, back = i["Ior"], i["Back"]
    eta = g.select(back, g.f("DIVIDE", 1.0, ior), ior)  # behind the surface over before it
    cosine = g.v("DOT_PRODUCT", normal, g.add("ShaderNodeNewGeometry").outputs["Incoming"])
    sine = g.f("DIVIDE", g.f("SUBTRACT", 1.0, g.f("MULTIPLY", cosine, cosine)), g.f("MULTIPLY", eta, eta))
    square = g.f("SUBTRACT", 1.0, sine)  # of the refracted ray's cosine
    refracted = g.f("SQRT", g.f("MAXIMUM", square, 0.0))
    across = fresnel_term(g, cosine, g.f("MULTIPLY", eta, refracted))
    along = fresnel_term(g, refracted, g.f("MULTIPLY", eta, cosine))
    share = g.f("MULTIPLY", g.f("MULTIPLY_ADD", across, across, g.f("MULTIPLY", along, along)), 0.5)
    share = g.select(g.f("COMPARE", eta, 1.0, 1e-7), 0.0, share)
    r, t, b = g.split(i["Transmit"])
    clear = g.f("GREATER_THAN", g.f("MAXIMUM", g.f("MAXIMUM", r, t), b), 0.0)
    total = g.f("MULTIPLY", clear, g.f("LESS_THAN", square, 0.0))
    refraction = g.add("ShaderNodeBsdfRefraction", distribution="SHARP")
    refraction.inputs["Roughness"].default_value = 0.0
    g.put(refraction.inputs["IOR"], ior)
    g.put(refraction.inputs["Normal"], normal)
    g.put(refraction.inputs["Color"],
          g.v("SCALE", i["Transmit"], g.f("SUBTRACT", 1.0, g.f("MULTIPLY", i["Fresnel"], share))))
    through = g.mix(total, refraction.outputs[0], mirror(g, (1.0, 1.0, 1.0), normal))
    part = g.f("MULTIPLY", g.select(i["Fresnel"], share, 1.0), g.f("SUBTRACT", 1.0, total))
    bit = g.f("FLOOR", g.f("DIVIDE", g.layer("scc_path", "Fac"), g.f("POWER", 2.0, depth)))
    return g.mix(g.f("MODULO", bit, 2.0), mirror(g, g.v("SCALE", i["Reflect"], part), normal), through)


def fresnel_term(g, a, b):
    return g.f("DIVIDE", g.f("SUBTRACT", a, b), g.f("MAXIMUM", g.f("ADD", a, b), 1e-20))


#: end
#: light
#: smooth
def light_from_below(g, light, to_light):
    """For light that comes from below the flat triangle but from above by the interpolated normal. Toon ignores it;
    Translucent's lobe is the cosine below over pi."""
    below = g.f("MULTIPLY", g.v("DOT_PRODUCT", g.add("ShaderNodeNewGeometry").outputs["Normal"], to_light), -2.0)
    share = g.f("DIVIDE", g.f("GREATER_THAN", below, 0.0), g.f("MAXIMUM", below, 1e-7))
    translucent = g.add("ShaderNodeBsdfTranslucent")
    g.put(translucent.inputs["Color"], g.v("SCALE", light, share))
    return translucent.outputs[0]


#: end
#: end
#: two_sided
def either_side(g, front, back, side):
    fields = {}
    for key, a in front.items():
        b = back[key]
        if a == b:
            fields[key] = a
        elif key in ("shininess", "ior", "fresnel"):
            fields[key] = g.f("MULTIPLY_ADD", side, b, g.f("MULTIPLY", g.f("SUBTRACT", 1.0, side), a))
        else:
            fields[key] = choose(g, side, a, b)
    return fields


#: end
#: bump
def bumped(g, normal, outward, slope):
    """The normal of the surface displaced outwards by a height of this slope; it is a dent from behind."""
    along = g.v("SUBTRACT", slope, g.v("SCALE", normal, g.v("DOT_PRODUCT", slope, normal)))
    side = g.f("SIGN", g.v("DOT_PRODUCT", normal, outward))
    return g.v("NORMALIZE", g.v("SUBTRACT", normal, g.v("SCALE", along, side)))


#: end
def exact_surface(g, sides, hit):
    fields = sides[0]
    #: two_sided
    if len(sides) > 1:
        fields = either_side(g, *sides, hit["Back"])
    #: end
    normal = hit["Normal"]
    #: bump
    normal = bumped(g, normal, hit["Outward"], fields["bump"])
    #: end
    inputs = {key: fields[key.lower()] for key in phong_group().inputs.keys() if key.lower() in fields}
    #: through
    inputs["Back"] = hit["Back"]
    #: end
    return g.group(phong_group(), Position=hit["Position"], Normal=normal, **inputs)["Shader"]


#: light
def exact_lamp(lamp, light):
    lamp.energy = 2 * math.pi / GAIN
    #: point
    if light["type"] == "POINT":
        lamp.shadow_soft_size, lamp.energy = 0.0, 8 * math.pi ** 2 / GAIN
        g, distance = lamp_graph(lamp)
        g.put(lamp.node_tree.nodes["Emission"].inputs["Strength"], g.f("MULTIPLY", distance, distance))
    #: end
    lamp.cycles.use_multiple_importance_sampling = False


#: end
def exact_world(world):
    g = Graph(world.node_tree)
    depth = g.f("SUBTRACT", g.add("ShaderNodeLightPath").outputs["Ray Depth"], 1.0)  # one more than at a surface
    now = g.f("COMPARE", depth, g.layer("scc_bounce", "Fac"), 0.25)
    g.put(world.node_tree.nodes["Background"].inputs["Strength"], g.f("MULTIPLY", now, g.layer("scc_glow", "Fac")))


#: spot
def cone_constants(light):
    """Where the cone ends, how fast it fades there, and its exponent, in cosines; no cone includes all of them."""
    inner, outer, exponent = light.get("cone", (-1.0, -2.0, 0.0))
    return outer, min(1e30, 1.0 / (inner - outer)) if inner > outer else 1e30, exponent


#: end
def layer_properties(light):
    #: light
    if light:
        return dict(scc_diffuse=light["diffuse"], scc_light=light.get("position") or light["to_light"],
                    #: point
                    scc_w=1.0 if "position" in light else 0.0,
                    #: attenuation
                    scc_attenuation=light.get("attenuation", (1.0, 0.0, 0.0)),
                    #: end
                    #: end
                    #: spot
                    scc_axis=tuple(-x for x in light.get("axis", BLACK)), scc_cone=cone_constants(light),
                    #: end
                    #: specular
                    scc_specular=light.get("specular", light["diffuse"]),
                    #: end
                    )
    #: end
    return {}


def exact_layers(scene, lamps):
    """One view layer per path and light, and the sum of all."""
    scene.use_nodes = True
    tree, first, total = scene.node_tree, scene.view_layers[0], None
    tree.nodes.clear()
    lights = list(LIGHTS.items()) or [("no light", None)]
    paths = ["R" * bounce for bounce in range(BOUNCES + 1)]
    #: through
    paths = PATHS
    #: end
    for path in paths:
        for number, (name, light) in enumerate(lights):
            layer = scene.view_layers.new(short(f"{len(path)}{path} {name}"))
            for other, lamp in lamps.items():
                layer.layer_collection.children[lamp.name].exclude = other != name
            properties = dict(layer_properties(light), scc_bounce=float(len(path)),
                              scc_path=float(sum(2 ** k for k, way in enumerate(path) if way == "T")),
                              scc_glow=float(number == 0))
            for key, value in properties.items():
                layer[key] = value
            node = tree.nodes.new("CompositorNodeRLayers")
            node.scene, node.layer = scene, layer.name
            image = node.outputs["Image"]
            if total:
                add = tree.nodes.new("CompositorNodeMixRGB")
                add.blend_type = "ADD"
                tree.links.new(total, add.inputs[1])
                tree.links.new(image, add.inputs[2])
                image = add.outputs[0]
            total = image
    tree.links.new(total, tree.nodes.new("CompositorNodeComposite").inputs[0])
    scene.view_layers.remove(first)


def exact_settings(scene, lamps):
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_auto_tile = 1, False, False
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01
    cycles.light_sampling_threshold = cycles.blur_glossy = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.max_bounces = cycles.glossy_bounces = BOUNCES
    cycles.diffuse_bounces = cycles.transmission_bounces = 0
    #: through
    cycles.transmission_bounces, cycles.transparent_max_bounces = BOUNCES, 1024
    #: end
    cycles.min_light_bounces = 1024
    exact_layers(scene, lamps)


