#include "compiler/backends/pov_texture.h"

#include "compiler/backends/pov_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace scc::compiler {

namespace {

using Color = runtime::Rgb<double>;

constexpr Color black{0, 0, 0};
constexpr Color white{1, 1, 1};
/// POV-Ray's limit for the entries of one map.
constexpr int most_map_entries = 256;

bool same_paint(const Paint& a, const Paint& b) {
    return a.function != runtime::no_function && a.function == b.function;
}

/// How a layer's pigment lets the layers below through.
enum class Layer { opaque, half, filter };

std::string_view suffix(Layer layer) {
    switch (layer) {
    case Layer::opaque:
        return "";
    case Layer::half:
        return " transmit 0.5";
    case Layer::filter:
        return " filter 1";
    }
    return "";
}

/// `head { items }` on one line where that is short, else an item per line.
std::string block(std::string_view head, const std::vector<std::string>& items) {
    std::string flat = fmt::format("{} {{", head), tall = flat;
    for (const std::string& item : items) {
        flat += ' ' + item;
        tall += "\n    ";
        for (const char c : item) {
            tall += c == '\n' ? "\n    " : std::string(1, c);
        }
    }
    const bool fits = flat.size() <= 96 && flat.find('\n') == std::string::npos;
    return fits ? flat + " }" : tall + "\n}";
}

void write(Writer& out, std::string_view lines) {
    while (!lines.empty()) {
        const std::size_t end = std::min(lines.find('\n'), lines.size());
        out.raw_line(lines.substr(0, end));
        lines.remove_prefix(std::min(end + 1, lines.size()));
    }
}

std::vector<std::string> function_map(const Paint::Part& part, double gain, Layer layer) {
    const auto entry = [&](int at, const Color& color) {
        return fmt::format("[{} rgb {}{}]", at, pov_color(color * gain), suffix(layer));
    };
    return {fmt::format("function {{ {} }}", part.t),
            fmt::format("color_map {{ {} {} }}", entry(0, part.low), entry(1, part.high))};
}

std::string pigment(const Paint& paint, double gain, Layer layer) {
    if (paint.is_constant()) {
        return fmt::format("pigment {{ rgb {}{} }}", pov_color(paint.constant * gain), suffix(layer));
    }
    if (paint.parts.size() == 1) {
        return block("pigment", function_map(paint.parts[0], gain, layer));
    }
    std::vector<std::string> entries;
    for (const Paint::Part& part : paint.parts) {
        const std::vector<std::string> map = function_map(part, 3 * gain, layer);
        entries.push_back(fmt::format("[1 {} {}]", map[0], map[1]));
    }
    return block("pigment", {block("average pigment_map", entries)});
}

/// A pigment and what it is lit by. Its coefficients count relative to the pigment.
struct Body {
    Paint paint;
    double diffuse = 0;
    Color ambient{}, emission{};
};

/// value / base per channel, where that exists and keeps its accuracy in floats.
std::optional<Color> ratio(const Color& value, const Color& base) {
    const auto channel = [](double v, double b) { return v == 0 ? 0 : v / b; };
    const Color result{channel(value.r, base.r), channel(value.g, base.g), channel(value.b, base.b)};
    const double largest = std::max({std::abs(result.r), std::abs(result.g), std::abs(result.b)});
    return largest < 1e6 ? std::optional(result) : std::nullopt;
}

/// Lets a body that exists shine with `paint`, by its coefficient `shine`.
bool join(Body& body, Color Body::*shine, const Paint& paint) {
    if (same_paint(body.paint, paint)) {
        body.*shine = white;
        return true;
    }
    if (!body.paint.is_constant() || !paint.is_constant()) {
        return false;
    }
    if (const auto coefficient = ratio(paint.constant, body.paint.constant)) {
        body.*shine = *coefficient;
        return true;
    }
    return false;
}

void add_shine(std::vector<Body>& bodies, Color Body::*shine, const Paint& paint) {
    if (paint.is_black()) {
        return;
    }
    for (Body& body : bodies) {
        if (join(body, shine, paint)) {
            return;
        }
    }
    Body body{paint.is_constant() ? Paint{white, {}} : paint};
    body.*shine = paint.is_constant() ? paint.constant : white;
    bodies.push_back(std::move(body));
}

/// As few pigments as can carry diffuse, ambient and emission; at least one.
std::vector<Body> bodies_of(const PaintedPhong& phong) {
    std::vector<Body> bodies;
    if (!phong.diffuse.is_black()) {
        bodies.push_back({phong.diffuse, 1});
    }
    add_shine(bodies, &Body::ambient, phong.ambient);
    add_shine(bodies, &Body::emission, phong.emission);
    if (bodies.empty()) {
        bodies.push_back({Paint{}});
    }
    return bodies;
}

bool is_grey(const Color& color) {
    return color.r == color.g && color.g == color.b;
}
bool has_equal_channels(const Paint& paint) {
    return paint.is_constant() && is_grey(paint.constant);
}

std::string highlight(double specular, const std::string& roughness) {
    return fmt::format(" specular {} roughness {}", number(specular), roughness);
}

std::string body_finish(const Body& body, double gain) {
    std::string text;
    if (!(body.ambient == black)) {
        text += " ambient rgb " + pov_color(body.ambient * gain);
    }
    if (body.diffuse != 0) {
        text += " diffuse " + number(body.diffuse * gain);
    }
    if (!(body.emission == black)) {
        text += " emission rgb scc_exposure*" + pov_color(body.emission * gain);
    }
    return text;
}

std::string layer_text(const PaintedPhong& phong, const std::string& pigment_text,
                       const std::string& finish_text) {
    std::vector<std::string> items{pigment_text};
    if (!phong.normal.empty()) {
        items.push_back(phong.normal);
    }
    if (!finish_text.empty()) {
        items.push_back(fmt::format("finish {{{} }}", finish_text));
    }
    return block("texture", items);
}

std::string reflection(const PaintedPhong& phong) {
    const std::string color = pov_color(phong.reflect.constant);
    return phong.reflect.is_black() ? ""
           : phong.fresnel ? fmt::format(" reflection {{ rgb 0 rgb {} fresnel on }} conserve_energy", color)
                           : fmt::format(" reflection {{ rgb {} }}", color);
}

/// A highlight's colour, but for channels that nothing could divide by.
Color filter_of(const Color& specular) {
    const auto channel = [](double s) { return std::max(s, 1e-7); };
    return {channel(specular.r), channel(specular.g), channel(specular.b)};
}

/// What filters the light from behind, with highlights and mirrors that none of the layers above has. It is
/// `gain` times too bright. A layer that colours the highlight filters that light too, which the bottom makes
/// up for; and with Fresnel's equations each layer's reflection dims all below it.
std::vector<std::string> clear_layers(const PaintedPhong& phong, const std::string& roughness, double gain,
                                      bool is_top) {
    const std::string mirror = is_top ? reflection(phong) : "";
    if (has_equal_channels(phong.specular)) {
        const bool shines = is_top && !phong.specular.is_black();
        const std::string shine = shines ? highlight(phong.specular.constant.r, roughness) : "";
        return {layer_text(phong, pigment(phong.transmit, gain, Layer::filter), shine + mirror)};
    }
    const Color filter = filter_of(phong.specular.constant);
    const Color& transmit = phong.transmit.constant;
    const Paint below{{transmit.r / filter.r, transmit.g / filter.g, transmit.b / filter.b}, {}};
    const std::string shine = highlight(1, roughness);
    std::vector<std::string> layers;
    if (phong.fresnel) {
        layers.push_back(layer_text(phong, pigment(below, 1, Layer::filter), mirror));
        layers.push_back(layer_text(phong, pigment(Paint{white, {}}, 1, Layer::filter), shine));
    } else {
        layers.push_back(layer_text(phong, pigment(below, 1, Layer::filter), shine + mirror));
    }
    layers.push_back(layer_text(phong, pigment(Paint{filter, {}}, gain, Layer::filter), ""));
    return layers;
}

/// Layers from the bottom. POV-Ray dims the light of a half transparent layer and of all below it by one
/// half, but not highlights and reflections of the top layer; it has no coloured highlights, so these are
/// white on a black layer at the bottom, under a layer that filters them.
std::vector<std::string> layers_of(const PaintedPhong& phong, const std::string& roughness) {
    const bool transparent = phong.fresnel || !phong.transmit.is_black();
    std::vector<Body> bodies = bodies_of(phong);
    if (transparent && bodies[0].paint.is_black()) {
        bodies.clear();
    }
    const bool colored_highlight = !has_equal_channels(phong.specular);
    const double gain_below = std::exp2(static_cast<double>(bodies.size()));
    std::vector<std::string> layers;
    if (transparent) {
        layers = clear_layers(phong, roughness, gain_below, bodies.empty());
    } else if (colored_highlight) {
        layers.push_back(layer_text(phong, pigment(Paint{}, 1, Layer::opaque), highlight(1, roughness)));
        layers.push_back(layer_text(phong, pigment(phong.specular, gain_below, Layer::filter), ""));
    }
    for (std::size_t above = bodies.size(); above-- > 0;) {
        const bool bottom = above + 1 == bodies.size() && !colored_highlight && !transparent;
        const double gain = std::exp2(static_cast<double>(above) + (bottom ? 0 : 1));
        std::string finish = body_finish(bodies[above], gain);
        if (above == 0 && !colored_highlight && !phong.specular.is_black()) {
            finish += highlight(phong.specular.constant.r, roughness);
        }
        if (above == 0) {
            finish += reflection(phong);
        }
        layers.push_back(
            layer_text(phong, pigment(bodies[above].paint, 1, bottom ? Layer::opaque : Layer::half), finish));
    }
    return layers;
}

Paint constant_paint(const Color& color) {
    return {color, {}, false, runtime::no_function};
}

} // namespace

bool has_writable_highlight(const PaintedPhong& phong) {
    const std::vector<Paint::Part>& parts = phong.specular.parts;
    const bool grey = phong.specular.is_constant()
                          ? is_grey(phong.specular.constant)
                          : parts.size() == 1 && is_grey(parts[0].low) && is_grey(parts[0].high);
    return phong.transmit.is_constant() || grey;
}

std::string PovTextures::declare(const std::string& name, const PaintedPhong& phong, Outcome& shininess) {
    if (!phong.reflect.is_constant()) {
        return declare_varying(name, phong, &PaintedPhong::reflect, shininess);
    }
    if (!phong.specular.is_constant() && !phong.transmit.is_black()) {
        return declare_varying(name, phong, &PaintedPhong::specular, shininess);
    }
    if (!phong.shininess.is_constant() && !phong.specular.is_black()) {
        return declare_varying_shininess(name, phong, shininess);
    }
    return declare_layers(name, phong);
}

/// A finish has a constant reflection and highlight; between two textures POV-Ray blends.
std::string PovTextures::declare_varying(const std::string& name, const PaintedPhong& phong,
                                         Paint PaintedPhong::*field, Outcome& shininess) {
    const std::vector<Paint::Part> parts = (phong.*field).parts;
    const auto share = static_cast<double>(parts.size());
    std::vector<std::string> blends;
    for (const Paint::Part& part : parts) {
        std::vector<std::string> ends;
        for (const Color& end : {part.low, part.high}) {
            PaintedPhong fixed = phong;
            fixed.*field = constant_paint(end * share);
            ends.push_back(declare(name, fixed, shininess));
        }
        blends.push_back(declare_blend(name, part.t, ends));
    }
    if (blends.size() == 1) {
        return blends[0];
    }
    const std::string average = names_.make(name);
    out_.line("#declare {} = texture {{ average texture_map {{ [1 {}] [1 {}] [1 {}] }} }}", average,
              blends[0], blends[1], blends[2]);
    return average;
}

/// A finish has a constant exponent; between textures with different ones POV-Ray blends.
std::string PovTextures::declare_varying_shininess(const std::string& name, const PaintedPhong& phong,
                                                   Outcome& shininess) {
    const Paint::Part part = phong.shininess.parts[0];
    const double low = std::max(part.low.r, 1e-3), high = std::max(part.high.r, 1e-3);
    if (low == high || phong.shininess.two_valued) {
        PaintedPhong at_low = phong, at_high = phong;
        at_low.shininess = constant_paint({low, low, low});
        at_high.shininess = constant_paint({high, high, high});
        const std::string first = declare_layers(name, at_low);
        return low == high ? first : declare_blend(name, part.t, {first, declare_layers(name, at_high)});
    }
    // Linear interpolation of x -> c^exp(x) with steps h is off by at most 0.039 h^2, whatever c is.
    const double whole = std::log(high / low);
    const double wanted = std::abs(whole) / std::sqrt(1e-6 / 0.039);
    const int steps = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, most_map_entries - 1.0));
    shininess = {Fidelity::approximated,
                 fmt::format("blended between {} textures; bound relative to the highlight", steps + 1),
                 0.039 * (whole / steps) * (whole / steps)};
    return declare_stops(name, phong, {low, high, steps});
}

std::string PovTextures::declare_stops(const std::string& name, const PaintedPhong& phong,
                                       const Stops& stops) {
    const Paint::Part part = phong.shininess.parts[0];
    const std::string macro = names_.make(name + "_at"), array = names_.make(name + "_stops");
    const std::string whole = number(std::log(stops.high / stops.low)), low = number(stops.low);
    out_.line("#macro {}(shininess)", macro);
    out_.indent();
    for (const std::string& layer : layers_of(phong, "1/shininess")) {
        write(out_, layer);
    }
    out_.dedent();
    out_.line("#end");
    out_.line("#declare {} = array[{}];", array, stops.steps + 1);
    out_.line("#for (stop, 0, {})", stops.steps);
    out_.line("    #declare {}[stop] = {}({}*exp({}*stop/{}))", array, macro, low, whole, stops.steps);
    out_.line("#end");
    const std::string value =
        fmt::format("{}*({}) + ({})", part.t, number(part.high.r - part.low.r), number(part.low.r));
    const std::string identifier = names_.make(name);
    out_.line("#declare {} = texture {{", identifier);
    out_.line("    function {{ min(max(ln(max({}, {})/{})/({}), 0), 1) }}", value,
              number(std::min(stops.low, stops.high)), low, whole);
    out_.line("    texture_map {{ #for (stop, 0, {}) [stop/{} {}[stop]] #end }}", stops.steps, stops.steps,
              array);
    out_.line("}}");
    return identifier;
}

std::string PovTextures::declare_blend(const std::string& name, const std::string& t,
                                       const std::vector<std::string>& textures) {
    const std::string blend = names_.make(name);
    write(out_, block(fmt::format("#declare {} = texture", blend),
                      {fmt::format("function {{ {} }}", t),
                       fmt::format("texture_map {{ [0 {}] [1 {}] }}", textures[0], textures[1])}));
    return blend;
}

std::string PovTextures::declare_layers(const std::string& name, const PaintedPhong& phong) {
    const std::string identifier = names_.make(name);
    // c^0 is 1; POV-Ray has no infinite roughness.
    const std::string roughness = number(1 / std::max(phong.shininess.constant.r, 1e-20));
    const std::vector<std::string> layers = layers_of(phong, roughness);
    if (layers.size() == 1) {
        write(out_, fmt::format("#declare {} = {}", identifier, layers[0]));
        return identifier;
    }
    out_.line("#declare {} =", identifier);
    out_.indent();
    for (const std::string& layer : layers) {
        write(out_, layer);
    }
    out_.dedent();
    return identifier;
}

} // namespace scc::compiler
