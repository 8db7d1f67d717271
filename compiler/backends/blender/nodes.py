# ---------------------------------------------------------------- node trees
Xyz = collections.namedtuple("Xyz", "x y z")


class Graph:
    """Short spellings for one node tree. An operand is a socket or a constant."""

    def __init__(self, tree):
        self.tree = tree

    def add(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        return node

    def group(self, tree, **operands):
        node = self.add("ShaderNodeGroup", node_tree=tree)
        for key, value in operands.items():
            self.put(node.inputs[key], value)
        return node.outputs

    def put(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, (tuple, list)):
            socket.default_value = (*value, 1.0) if len(socket.default_value) > len(value) else tuple(value)
        else:
            socket.default_value = value

    def f(self, operation, *operands):
        """A Math node."""
        node = self.add("ShaderNodeMath", operation=operation)
        for socket, value in zip(node.inputs, operands):
            self.put(socket, value)
        return node.outputs[0]

    #: function field through
    def select(self, truth, if_so, if_not):
        return self.f("MULTIPLY_ADD", truth, if_so, self.f("MULTIPLY", self.f("SUBTRACT", 1.0, truth), if_not))

    #: end
    #: image
    def image(self, name, u, v):
        node = self.add("ShaderNodeTexImage", image=image_data(name), interpolation=IMAGES[name]["filter"],
                        extension=IMAGES[name]["wrap"])
        self.put(node.inputs[0], self.join(u, v, 0.0))
        return self.split(node.outputs["Color"])

    #: end
    def v(self, operation, *operands):
        """A Vector Math node."""
        node = self.add("ShaderNodeVectorMath", operation=operation)
        sockets = (node.inputs[0], node.inputs["Scale"]) if operation == "SCALE" else node.inputs
        for socket, value in zip(sockets, operands):
            self.put(socket, value)
        return node.outputs["Value" if operation in ("DOT_PRODUCT", "LENGTH") else "Vector"]

    def split(self, vector):
        node = self.add("ShaderNodeSeparateXYZ")
        self.put(node.inputs[0], vector)
        return Xyz(*node.outputs)

    def join(self, *components):
        node = self.add("ShaderNodeCombineXYZ")
        for socket, value in zip(node.inputs, components):
            self.put(socket, value)
        return node.outputs[0]

    #: light
    def sum(self, first, second):
        node = self.add("ShaderNodeAddShader")
        self.put(node.inputs[0], first)
        self.put(node.inputs[1], second)
        return node.outputs[0]

    #: end
    #: mirror
    def mix(self, part, first, second):
        node = self.add("ShaderNodeMixShader")
        for socket, value in zip(node.inputs, (part, first, second)):
            self.put(socket, value)
        return node.outputs[0]

    #: end
    def attribute(self, kind, name, output="Vector"):
        return self.add("ShaderNodeAttribute", attribute_type=kind, attribute_name=name).outputs[output]

    def layer(self, name, output="Vector"):
        """A custom property of the view layer that is being rendered."""
        return self.attribute("VIEW_LAYER", name, output)

    def to_object(self, vector):
        """A world direction in object space, its length scaled along."""
        node = self.add("ShaderNodeVectorTransform", vector_type="VECTOR", convert_from="WORLD", convert_to="OBJECT")
        self.put(node.inputs[0], vector)
        return node.outputs[0]


def new_group(name, inputs, outputs):
    """An empty node group with sockets given as name=type; its graph, inputs and outputs."""
    tree = own(bpy.data.node_groups.new(short("scc " + name), "ShaderNodeTree"))
    for key, kind in inputs.items():
        tree.inputs.new("NodeSocket" + kind, key)
    for key, kind in outputs.items():
        tree.outputs.new("NodeSocket" + kind, key)
    g = Graph(tree)
    return g, g.add("NodeGroupInput").outputs, g.add("NodeGroupOutput").inputs


