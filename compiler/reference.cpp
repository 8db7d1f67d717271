#include "compiler/reference.h"

#include "compiler/schema.h"
#include "lang/builtins.h"
#include "lang/check.h"
#include "lang/diagnostic.h"
#include "lang/parser.h"
#include "lang/type.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <vector>

namespace scc::compiler {

namespace {

using Row = std::pair<std::string_view, std::string_view>;

constexpr std::string_view head = R"(# The `.scn` language

This file is what `scc reference` prints: its tables are the compiler's own. [grammar.md](grammar.md) has the grammar.

`{}` builds a thing, `()` computes a value, `[]` lists values. A name is bound once; the order of definitions does not matter.
Writing a thing on a line of its own adds it to what surrounds it. A number never turns into an angle, a vector or a colour.

```scn
let red = phong { diffuse = rgb(0.7, 0.1, 0.1), specular = rgb(0.5, 0.5, 0.5) }
sphere { radius = 1, material = red, transform = scale(1, 0.7, 1) then translate(0, 0.7, 0) }
plane { normal = (0, 1, 0) }
perspective_camera { eye = (4, 3, 6), fov_y = 40deg }
point_light { position = (4, 6, 3) }
```

## Statements

| statement | does |
| --- | --- |
| `language 1` | the first line of a file, if it is there: the language's version |
| `import "file.scn" as name with { param = value }` | reads another scene; see [Imports](#imports) |
| `param name: type = default in low..high "text"` | a value that `-D name=value` sets; range and text may be left out |
| `let name: type = value` | names a value; the type may be left out |
| `fn name(a: type, b: type = default) -> type = value` | a function; the result's type is needed only where it calls itself. The body is a value, or `{ }` with `let`s and a value at its end |
| `for (name in range) { items }` | the items for each number of a range or element of a list |
| `if (condition) { items } else { items }` | the items of one branch; `else` may be left out |
| `name = value` | within a thing: sets a field |
| `value` | adds a thing, or all things of a list, to what surrounds it |
| `assert(condition, "text")`, `print(value)` | see [Functions](#functions) |

```scn
language 1
param count: number = 5 in 1..100 "how many balls"
fn height(i: number, step: number = 0.5) -> number {
  let base = 1
  base + i * step
}
for (i in 0..count) {
  if (i % 2 == 0) { sphere { center = (i, height(i), 0), radius = 0.4 } } else { box { transform = translate(i, 0, 0) } }
}
assert(count < 100, "not too many")
```

## Values

| literal | is |
| --- | --- |
| `1`, `0.5`, `1e-3` | a number |
| `25mm`, `1cm`, `2m`, `1km`, `1inch` | a number: the length in the `unit` of the file's `world` |
| `30deg`, `0.5rad` | an angle; angle times number is an angle, angle over angle a number |
| `true`, `false` | a bool |
| `"text"` | a string; its escapes are `\"` `\\` `\n` `\t` |
| `#c83232` | a colour, display-encoded as in `srgb` |
| `(1, 2)`, `(1, 2, 3)` | a vec2, a vec3; `.x .y .z` are its parts, `.r .g .b` those of a colour |
| `[1, 2, 3]`, `[for (i in 0..3) i * i]` | a list; `list[0]` is its first element |
| `0..5` | a range: the whole numbers 0 to 4 |
| `fn(x: number) = x * x` | a function |
| `if (condition) a else b` | one of two values |
| `pi` | the number 3.14159... |
| `frame`, `time` | the number of the frame and its time in seconds; see [Frames](#frames) |

```scn
world { unit = "cm" }
let squares = [for (i in 0..4) i * i]
let twice = fn(x: number) = 2 * x
assert(squares[3] == 9 and len(squares) == 4, "from 0 to 3")
assert(25mm == 2.5, "in centimetres")
assert(180deg / 90deg == 2, "a number")
assert(twice(if (1 < 2) 3 else 4) == 6, "a function is a value")
assert((1, 2, 3).z == 3 and #ffffff.r == 1, "parts")
```

)";

constexpr std::string_view imports = R"(## Imports

An imported file is read as a scene of its own, beside the importing one. Its `let`, `fn` and `param` are reached as `name.x`;
`name.scene`, on a line of its own, adds its shapes (together in a group `name`, so their paths are `name/...`), its lights and
its cameras (named `name/...`). Its `render` and its `world` stay behind: background and ambient light are the importing scene's.
Nothing is added by the `import` itself.

- `with` sets params; later wins: default, `with`, `-D name.param=value`.
- The same file imported twice is two instances, each with its params.
- Paths are relative to the importing file and stay within the folder of the scene, or that of an `--asset-path`. Assets of an
  imported file are looked for beside it, then beside the scene.
- Lengths with a unit count in the `unit` of the file that they stand in; a file without one takes that of the file that imports
  it. Where the two differ, a warning says the factor.
- In a group, `name.scene` may hold shapes only. A name `scene` that the file itself binds cannot be reached.
- An import needs the values of its `with`, and what uses a name of it needs all of it: a definition by way of both is a cycle.

```scn
// studio.scn
param power: number = 1 in 0..10 "of the key light"
let grey = phong { diffuse = rgb(0.4, 0.4, 0.4) }
point_light { position = (0, 5, 5), color = rgb(power, power, power) }
perspective_camera { eye = (0, 1, 6) }
plane { normal = (0, 1, 0), material = grey }
```

```scn
import "studio.scn" as studio with { power = 2 }
studio.scene
sphere { center = (0, 1, 0), material = studio.grey }
```

## Frames

A scene whose `render` has `frames` is an animation; the end of the range is excluded. `frame` is the number of the frame that
is drawn and `time` is `frame / frame_rate`, in seconds; `frames` itself cannot depend on them. They are known in imported files
too. Of several such `render`s the first one counts, which stands at the top of the scene's own file.
`scc render --frames 0..48 -o name_####.png` draws frames, the last one excluded, `--frame 7` one of them; without either the first
one is drawn. `scc check` looks at the first and the last.

```scn
sphere { center = (2 * cos(time * 90deg), 0, 2 * sin(time * 90deg)) }
render { frames = 0..96, frame_rate = 24 }
```

)";

constexpr std::string_view surfaces = R"(## Coordinates on surfaces

`s.uv` is a vec2 of a shape's own, before its transform. Seen from outside, u grows to the right and v upwards, so that a
picture over (0, 0) to (1, 1) is upright and not mirrored.

| shape | `s.uv` |
| --- | --- |
| `sphere` | (0, 0) to (1, 1): longitude about the y axis, 1/2 towards z and 3/4 towards x, and latitude, 1 towards y |
| `box` | (0, 0) to (1, 1) on each face, y upwards; on the faces across y, -z goes up at the top and z at the bottom |
| `cylinder`, `cone` | the side: u around the axis as on a sphere, v from 0 at `from` to 1 at `to`; a cap: as a disc |
| `disc` | (0, 0) to (1, 1) over the square around it |
| `plane` | lengths from the origin: (x, -z) where `normal` is the y axis |
| `triangle` | `uvs` at its corners, else (0, 0), (1, 0), (0, 1); interpolated |
| `mesh` | the file's texture coordinates, interpolated; (0, 0) where it has none, with a warning |
| `torus` | u around the axis as on a cylinder; v around the tube, 1/2 farthest from the axis, more towards the axis's end |
| `heightfield` | (0, 0) to (1, 1), as its field is called |
| `implicit`, `quadric` | (x, y) of the point |

The members of solids keep theirs. Upwards on a flat surface is the direction that comes nearest to y; where the normal is nearer to
the y axis than to the others, to -z (z, where it points down). An axis other than y is turned likewise.

The texel with its centre at ((i + 1/2) / width, (j + 1/2) / height) is in column i and in row j from the bottom of the file's
picture. Codes become linear light before they are blended.

)";

constexpr std::array types{
    Row{"number", "a double"},
    Row{"angle", "with a unit: `30deg`"},
    Row{"bool", "`true` or `false`"},
    Row{"string", "a text"},
    Row{"vec2", "two numbers"},
    Row{"vec3", "three numbers"},
    Row{"color", "linear light with Rec.709 primaries"},
    Row{"transform", "an affine map; `a then b` does a first"},
    Row{"range", "`0..5`: whole numbers, the end excluded"},
    Row{"surface", "the argument of a function of a point: `s.p` in the object's space, `s.world`, the "
                   "normal `s.n`, the "
                   "coordinates on the surface `s.uv`; where what the function gives is no number, as the "
                   "logarithm of a negative one, it counts as 0"},
    Row{"shape", "what a shape's constructor makes"},
    Row{"material", "what a material's constructor makes"},
    Row{"light", "what a light's constructor makes"},
    Row{"camera", "what a camera's constructor makes"},
    Row{"image", "what `image` makes: a function of a vec2 that gives a color"},
    Row{"setting", "`world` or `render`"},
    Row{"method", "`ray` or `raster`"},
    Row{"scene", "what `name.scene` of an import is"},
};

constexpr std::array words{
    Row{"language", "version of the language, on the first line"},
    Row{"import", "reads another scene"},
    Row{"as", "its name"},
    Row{"with", "its params"},
    Row{"param", "a value that can be set from outside"},
    Row{"let", "names a value"},
    Row{"fn", "a function"},
    Row{"for", "repeats items or elements"},
    Row{"in", "what `for` runs over; the range of a `param`"},
    Row{"if", "a choice between items or values"},
    Row{"else", "the other branch"},
    Row{"then", "joins transforms, the first one first"},
    Row{"and", "both; the right side is looked at only if the left holds"},
    Row{"or", "one of them; the right side is looked at only if the left does not hold"},
    Row{"not", "the opposite"},
    Row{"true", "a bool"},
    Row{"false", "a bool"},
};

constexpr std::array reserved{
#define SCC_TOKEN(kind, spelling) Row{#kind, spelling},
#include "lang/tokens.def"
#undef SCC_TOKEN
};

constexpr std::string_view operators = R"(## Operators

From the weakest to the strongest; those of a row are equally strong.

| operator | takes | gives |
| --- | --- | --- |
| `a then b` | transforms | a transform: first a, then b |
| `a or b` | bools | a bool |
| `a and b` | bools | a bool |
| `a == b`, `a != b` | two of one type: number, angle, bool, string, vec2, vec3, color | a bool |
| `a < b`, `a <= b`, `a > b`, `a >= b` | numbers or angles | a bool |
| `a..b` | numbers | a range |
| `a + b`, `a - b` | two of one type: number, angle, vec2, vec3, color | the same |
| `a * b`, `a / b`, `a % b` | numbers, angles, vectors or colours, one of them may be a number; `%` has the sign of the divisor | the same, component by component |
| `-a`, `not a` | what `+` takes; a bool | the same |
| `a ^ b` | numbers | a number; `a ^ b ^ c` is `a ^ (b ^ c)` |

```scn
assert(-7 % 3 == 2 and 2 ^ 3 ^ 2 == 512 and -2 ^ 2 == -4, "numbers")
assert(2 * (1, 2, 3) == (2, 4, 6) and (1, 2) * (3, 4) == (3, 8), "component by component")
sphere { transform = scale(2) then translate(1, 0, 0) }
```

)";

/// One for each constructor that is supported.
const std::map<std::string_view, std::string_view>& examples() {
    static const std::map<std::string_view, std::string_view> rows{
        {"sphere", "sphere { center = (0, 1, 0), radius = 0.5 }"},
        {"box", "box { min = (-1, 0, -1), max = (1, 2, 1) }"},
        {"plane", "plane { normal = (0, 1, 0), offset = -1 }"},
        {"cylinder", "cylinder { from = (0, 0, 0), to = (0, 2, 0), radius = 0.3, caps = false }"},
        {"cone", "cone { from = (0, 0, 0), to = (0, 2, 0), radius_from = 1, radius_to = 0.2 }"},
        {"disc", "disc { normal = (0, 0, 1), radius = 1, hole = 0.5 }"},
        {"triangle", "triangle { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] }"},
        {"torus", "torus { center = (0, 0.3, 0), axis = (0, 1, 0), major = 1, minor = 0.3 }"},
        {"quadric", "quadric { // a hyperboloid of one sheet\n  squares = (1, -0.5, 1)\n  constant = -0.2\n  "
                    "within = box { min = (-2, -1, -2), max = (2, 1, 2) }\n}"},
        {"heightfield", "fn waves(uv: vec2) -> number = 0.5 + 0.5 * sin(20 * uv.x) * cos(15 * uv.y)\n"
                        "heightfield { field = waves, size = (8, 8), height = 0.4, cells = (64, 64) }"},
        {"polyline", "polyline { points = [(0, 0, 0), (1, 1, 0), (2, 0, 0)], radius = 0.05 }"},
        {"mesh", "fn model(file: string) -> shape = mesh { file = file, normals = \"smooth\" }"},
        {"group", "group {\n  transform = rotate_y(30deg)\n  sphere { }\n  sphere { center = (2, 0, 0) }\n}"},
        {"implicit", "implicit {\n  field = fn(p: vec3) = p.x ^ 4 + p.y ^ 4 + p.z ^ 4 - 1\n  within = sphere "
                     "{ radius = 1.5 }\n}"},
        {"union", "union {\n  sphere { }\n  cylinder { radius = 0.5, to = (0, 2, 0) }\n}"},
        {"intersection", "intersection {\n  sphere { radius = 1.3 }\n  box { }\n}"},
        {"difference", "difference {\n  box { }\n  sphere { radius = 1.3 }\n}"},
        {"phong",
         "sphere { material = phong { diffuse = rgb(0.2, 0.4, 0.8), specular = rgb(0.5, 0.5, 0.5), "
         "shininess = 60 } }\n"
         "sphere { material = phong { diffuse = fn(s: surface) = rgb(0.5 + 0.4 * sin(9 * s.p.x), 0.2, "
         "0.2) } }\n"
         "disc { material = phong { diffuse = rgb(0.1, 0.6, 0.1), opacity = 0.5 } }\n"
         "box { material = phong { diffuse = rgb(0, 0, 0), transmit = rgb(0.9, 0.6, 0.6), ior = 1.5 } }\n"
         "torus { material = phong { bump = fn(s: surface) = 0.02 * noise(s.p * 20) } }"},
        {"glass", "sphere { material = glass { ior = 1.33, tint = rgb(0.9, 0.95, 1) } }"},
        {"two_sided", "let mirror = phong { diffuse = rgb(0.1, 0.1, 0.1), reflect = rgb(0.8, 0.8, 0.8) }\n"
                      "disc { material = two_sided { front = mirror, back = phong { } } }"},
        {"image", "let wood = image { file = \"wood.png\" }\nfn grain(s: surface) -> color = wood(s.uv * 4)\n"
                  "fn plank(width: number) -> shape = box { max = (width, 1, 1), material = phong { diffuse "
                  "= grain } }"},
        {"point_light", "point_light { position = (4, 6, 3), attenuation = (1, 0.05, 0.01) }"},
        {"spot_light",
         "spot_light { position = (0, 5, 2), target = (0, 0, 0), inner = 15deg, outer = 20deg }"},
        {"rectangle_light", "rectangle_light { corner = (-1, 4, -1), edge_u = (2, 0, 0), edge_v = (0, 0, 2), "
                            "samples = (6, 6) }"},
        {"directional_light", "directional_light { direction = (-1, -2, -1), color = rgb(0.3, 0.3, 0.35) }"},
        {"perspective_camera", "perspective_camera { eye = (4, 3, 6), target = (0, 0.5, 0), fov_y = 40deg }"},
        {"orthographic_camera", "orthographic_camera { eye = (3, 2.5, 4), height = 3 }"},
        {"spherical_camera", "spherical_camera { eye = (0, 1.6, 0), target = (0, 1.6, -1) }"},
        {"world", "world { ambient = rgb(0.2, 0.2, 0.2), background = #202830, unit = \"cm\" }"},
        {"render", "render { file = \"ray.png\", size = (640, 480), method = ray { depth = 4 } }"},
        {"ray", "render { method = ray { depth = 4, samples = 16, shadows = false } }"},
        {"raster",
         "let lines = raster { shading = \"wireframe\", cull = \"back\" }\nrender { method = lines }"},
    };
    return rows;
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        result += c == '|' ? "\\|" : std::string(1, c);
    }
    return result;
}

/// A row's message as it reads: its doubled braces are format strings' way to write one.
std::string unformatted(std::string_view message) {
    std::string text;
    for (std::size_t i = 0; i < message.size(); ++i) {
        text += message[i];
        const bool doubled = i + 1 < message.size() && message[i + 1] == message[i];
        i += doubled && (message[i] == '{' || message[i] == '}') ? 1 : 0;
    }
    return text;
}

std::string block(std::string_view text) {
    return fmt::format("```scn\n{}\n```\n\n", text);
}

// ---- constructors --------------------------------------------------------------------------------------

std::string bound(const lang::Field& field, double value) {
    return field.type.kind == lang::TypeKind::angle ? lang::to_string(lang::Value{lang::AngleValue{{value}}})
                                                    : fmt::format("{}", value);
}

std::string range_of(const lang::Field& field) {
    std::string text;
    for (const std::string_view choice : field.choices) {
        text += fmt::format("{}`\"{}\"`", text.empty() ? "" : ", ", choice);
    }
    const lang::Limits& limits = field.limits;
    if (std::isfinite(limits.min)) {
        text += (limits.min_excluded ? "> " : ">= ") + bound(field, limits.min);
    }
    if (std::isfinite(limits.max)) {
        text += (text.empty() ? "<= " : ", <= ") + bound(field, limits.max);
    }
    if (limits.integer || limits.square) {
        text += limits.square ? ", square" : ", whole";
    }
    return limits.nonzero_vector ? "not the zero vector" : text;
}

std::string type_of(const lang::Field& field) {
    const std::string type = lang::to_string(field.type);
    return field.per_point ? fmt::format("`{0}` or `fn(surface) -> {0}`", type) : "`" + type + "`";
}

std::string default_of(const lang::Field& field) {
    return field.required        ? "required"
           : field.default_value ? "`" + lang::to_string(*field.default_value) + "`"
                                 : "";
}

std::string constructor_text(const lang::Constructor& row) {
    std::string text =
        fmt::format("### {}\n\nA {}: {}.", row.name, lang::to_string(lang::Type(row.type)), row.doc);
    text += row.takes_children ? " Its items are shapes.\n\n" : "\n\n";
    text += "| field | type | default | range | |\n| --- | --- | --- | --- | --- |\n";
    std::string later;
    for (const lang::Field& field : row.fields) {
        if (!field.supported) {
            later += fmt::format("{}`{}`", later.empty() ? "" : ", ", field.name);
            continue;
        }
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.name, type_of(field), default_of(field),
                            range_of(field), escaped(field.doc));
    }
    text += later.empty() ? "\n" : fmt::format("\nNot supported yet: {}.\n\n", later);
    return text + block(examples().at(row.name));
}

std::string constructors_text() {
    std::string text = "## Constructors\n\n";
    std::string later;
    for (const lang::Constructor& row : scene_schema().constructors) {
        if (row.supported) {
            text += constructor_text(row);
        } else {
            later += fmt::format("{}`{}`", later.empty() ? "" : ", ", row.name);
        }
    }
    return text + fmt::format("Not supported yet: {}.\n\n", later);
}

// ---- the other tables ----------------------------------------------------------------------------------

/// What the compiler prints for the expression.
std::string value_of(std::string_view expression) {
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    const lang::FileId file = sources.add("example", fmt::format("print({})", expression));
    const auto tree = lang::parse_file(sources, file, diagnostics);
    const lang::Module module = lang::check(tree, scene_schema(), {}, sources, diagnostics);
    return module.prints.empty() ? "" : module.prints.front();
}

std::string functions_text() {
    std::string text = "## Functions\n\nArguments are given by position, or by name: `mix(a = 1, b = 2, t = "
                       "0.5)`. The list functions take them by position.\n\n";
    for (const lang::FunctionDoc& row : lang::function_docs()) {
        text += fmt::format("### {}\n\n", row.name);
        for (const std::string& signature : row.signatures) {
            text += fmt::format("- `{}`\n", signature);
        }
        const bool is_statement = lang::is_statement(row.name);
        text += fmt::format("\n{}.\n\n", row.doc);
        text += is_statement ? block(row.example)
                             : block(fmt::format("print({}) // {}", row.example, value_of(row.example)));
    }
    return text;
}

template <class Rows>
std::string table(std::string_view title, std::string_view header, const Rows& rows) {
    std::string text = fmt::format("## {}\n\n{}", title, header);
    for (const Row& row : rows) {
        text += fmt::format("| `{}` | {} |\n", row.first, row.second);
    }
    return text + "\n";
}

std::string words_text() {
    std::map<std::string_view, std::string_view> docs(words.begin(), words.end());
    std::vector<Row> rows;
    for (const auto& [kind, spelling] : reserved) {
        if (kind.starts_with("kw_")) {
            rows.emplace_back(spelling, docs[spelling]);
        }
    }
    return table("Reserved words", "They cannot be names.\n\n| word | |\n| --- | --- |\n", rows);
}

std::string types_text() {
    std::map<std::string_view, std::string_view> docs(types.begin(), types.end());
    std::vector<Row> rows;
    for (const std::string_view name : lang::type_names()) {
        rows.emplace_back(name, docs[name]);
    }
    rows.emplace_back("[T]", "a list of T");
    rows.emplace_back("fn(A, B) -> C", "a function");
    return table("Types",
                 "Parameters of functions state their types; elsewhere a type is found.\n\n| type | |\n| --- "
                 "| --- |\n",
                 rows) +
           block("fn twice(f: fn(number) -> number, x: number) = f(f(x))\n"
                 "let names: [string] = [\"a\", \"b\"]\n"
                 "assert(twice(fn(x: number) = x + 1, 5) == 7 and len(names) == 2, \"typed\")");
}

std::string limits_text() {
    const lang::EvaluationLimits limits;
    return fmt::format("## Limits\n\nWhat exceeds one of them is an error.\n\n| limit | |\n| --- | --- |\n"
                       "| brackets, blocks and operators within each other | {} |\n"
                       "| operators in a chain | {} |\n"
                       "| steps of evaluation | {} |\n"
                       "| calls within calls | {} |\n"
                       "| elements of a list, things of a scene | {} |\n"
                       "| bytes of a string, of all that is printed | {} |\n"
                       "| imports, each use counted | {} |\n"
                       "| imports within imports | {} |\n\n",
                       lang::max_nesting, lang::max_chain, limits.steps, limits.call_depth,
                       limits.list_length, limits.string_length, limits.imports, limits.import_depth);
}

std::string diagnostics_text() {
    std::string text =
        "## Diagnostics\n\nWhat `scc` says of a scene, by the name in brackets; `{}` stands for what "
        "it is about.\n\n| name | | message |\n| --- | --- | --- |\n";
    for (const lang::DiagnosticRow& row : lang::diagnostic_rows()) {
        const std::string_view severity = row.severity == lang::Severity::error     ? "error"
                                          : row.severity == lang::Severity::warning ? "warning"
                                                                                    : "note";
        text += fmt::format("| {} | {} | {} |\n", row.name, severity, escaped(unformatted(row.message)));
    }
    return text;
}

} // namespace

std::string reference_text() {
    return std::string(head) + types_text() + std::string(operators) + words_text() + std::string(imports) +
           std::string(surfaces) + constructors_text() + functions_text() + limits_text() +
           diagnostics_text();
}

} // namespace scc::compiler
