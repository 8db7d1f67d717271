# ---------------------------------------------------------------- command line
def size(text):
    width, separator, height = text.partition("x")
    if not (separator and all(n.isdecimal() and 4 <= int(n) <= 65536 for n in (width, height))):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT with 4 to 65536 pixels each")
    return int(width), int(height)


def positive(text):
    if not (text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number greater than 0")
    return int(text)


def picture(text):
    if not text.lower().endswith(".exr"):
        raise argparse.ArgumentTypeError(f"{text!r} does not end in .exr; the picture is linear 32-bit OpenEXR")
    folder = os.path.dirname(os.path.abspath(text))
    if not os.path.isdir(folder):
        raise argparse.ArgumentTypeError(f"{folder!r} is not a folder")
    return os.path.abspath(text)


def arguments():
    parser = argparse.ArgumentParser(
        prog="blender -b --factory-startup --python-exit-code 1 -P SCRIPT --",
        description="Builds the scene; with --render also draws it. In Blender's Text editor: Run Script, then F12.")
    parser.add_argument("--render", type=picture, metavar="FILE.exr", help="draw to this file (linear, 32-bit float)")
    parser.add_argument("--size", type=size, default=SIZE, metavar="WxH", help="of the picture; default: the scene's")
    parser.add_argument("--look", choices=("exact", "artist"), default="exact",
                        help="exact: pixel for pixel what scc draws, one sample at each pixel's centre; "
                             "artist: Principled materials and soft lamps to work on")
    #: lens
    samples = "per pixel, through as many points of the lens; default: 64"
    #: end
    #: pinhole
    samples = "per pixel, of the artist look; default: 64"
    #: end
    parser.add_argument("--samples", type=positive, default=64, help=samples)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def render_to(scene, path):
    """Under a temporary name first, so that an interrupted run leaves no half of a picture."""
    folder, name = os.path.split(path)
    temporary = os.path.join(folder, f".{name}.{os.getpid()}.exr")
    scene.render.filepath, scene.render.use_file_extension = temporary, False
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
        if not os.path.exists(temporary):
            raise OSError(f"Blender has not written {path}")
        os.replace(temporary, path)
    finally:
        scene.render.filepath = path
        if os.path.exists(temporary):
            os.remove(temporary)


def main():
    global SIZE
    options = arguments()
    SIZE = options.size
    scene = build(options.look, options.samples)
    if bpy.context.window:
        bpy.context.window.scene = scene
    if options.render:
        render_to(scene, options.render)


if __name__ == "__main__":
    main()
