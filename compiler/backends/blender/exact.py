# ---------------------------------------------------------------- exact look
# Each view layer follows the paths with a given number of mirror bounces and lights them by one light, whose
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
    glossy = g.add("ShaderNodeBsdfGlossy", distribution="SHARP")
    glossy.inputs["Roughness"].default_value = 0.0
    g.put(glossy.inputs["Color"], i["Reflect"])
    g.put(glossy.inputs["Normal"], normal)
    mix = g.add("ShaderNodeMixShader")
    g.put(mix.inputs[0], g.f("LESS_THAN", depth, g.f("SUBTRACT", bounce, 0.5)))
    g.put(mix.inputs[1], shader)
    g.put(mix.inputs[2], glossy.outputs[0])
    shader = mix.outputs[0]
    #: end
    g.put(out["Shader"], shader)
    return g.tree


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
        elif key == "shininess":
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
    """One view layer per number of bounces and light, and the sum of all."""
    scene.use_nodes = True
    tree, first, total = scene.node_tree, scene.view_layers[0], None
    tree.nodes.clear()
    lights = list(LIGHTS.items()) or [("no light", None)]
    for bounce in range(BOUNCES + 1):
        for number, (name, light) in enumerate(lights):
            layer = scene.view_layers.new(short(f"{bounce} {name}"))
            for other, lamp in lamps.items():
                layer.layer_collection.children[lamp.name].exclude = other != name
            properties = dict(layer_properties(light), scc_bounce=float(bounce), scc_glow=float(number == 0))
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
    cycles.min_light_bounces = 1024
    exact_layers(scene, lamps)


