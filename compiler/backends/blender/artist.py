# ---------------------------------------------------------------- artist look
# Principled materials, lamps with a size, many samples: to work on, not to compare with.
def principled(g, fields):
    shader = g.add("ShaderNodeBsdfPrincipled")
    reflect = fields.get("reflect", (0.0, 0.0, 0.0))
    metallic = 0.0 if isinstance(reflect, bpy.types.NodeSocket) else max(reflect)
    diffuse = fields["diffuse"]
    if metallic and not isinstance(diffuse, bpy.types.NodeSocket):
        diffuse = tuple((1 - metallic) * d + r for d, r in zip(diffuse, reflect))
    g.put(shader.inputs["Base Color"], diffuse)
    shader.inputs["Metallic"].default_value = min(1.0, metallic)
    #: emission
    g.put(shader.inputs["Emission"], fields["emission"])
    #: end
    shader.inputs["Specular"].default_value = 0.0
    #: specular
    specular, shininess = fields["specular"], fields["shininess"]
    if not isinstance(specular, bpy.types.NodeSocket):
        shader.inputs["Specular"].default_value = min(1.0, sum(specular) / 3)
    g.put(shader.inputs["Roughness"], g.f("POWER", g.f("DIVIDE", 2.0, g.f("ADD", shininess, 2.0)), 0.25))
    #: end
    if metallic:
        shader.inputs["Roughness"].default_value = 0.05
        for link in shader.inputs["Roughness"].links:
            g.tree.links.remove(link)
    return shader.outputs[0]


def artist_surface(g, sides, hit):
    shaders = [principled(g, fields) for fields in sides]
    #: two_sided
    if len(shaders) > 1:
        mix = g.add("ShaderNodeMixShader")
        for socket, value in zip(mix.inputs, (hit["Back"], *shaders)):
            g.put(socket, value)
        return mix.outputs[0]
    #: end
    return shaders[0]


#: light
def artist_lamp(lamp, light):
    #: spot
    if "cone" in light:
        lamp.type = "SPOT"
        lamp = bpy.data.lights[lamp.name]  # of the new type's class
        inner, outer, _ = light["cone"]
        lamp.spot_size, lamp.spot_blend = 2 * math.acos(outer), (inner - outer) / (1 - outer)
    #: end
    lamp.color, lamp.energy = light["diffuse"], math.pi
    #: directional
    if light["type"] == "SUN":
        lamp.angle = 0.01
    #: end
    #: point
    if light["type"] == "POINT":
        lamp.shadow_soft_size, lamp.energy = EXTENT / 100, 4 * math.pi ** 2
        g, d = lamp_graph(lamp)
        kc, kl, kq = light.get("attenuation", (1.0, 0.0, 0.0))
        polynomial = g.f("MULTIPLY_ADD", g.f("MULTIPLY_ADD", kq, d, kl), d, kc)
        g.put(lamp.node_tree.nodes["Emission"].inputs["Strength"], g.f("DIVIDE", g.f("MULTIPLY", d, d), polynomial))
    #: end


#: end
def artist_settings(scene, samples):
    scene.cycles.samples, scene.cycles.max_bounces = samples, 8


