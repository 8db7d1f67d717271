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

std::string function_map(const Paint::Part& part, double gain, Layer layer) {
    const auto entry = [&](int at, const Color& color) {
        return fmt::format("[{} rgb {}{}]", at, pov_color(color * gain), suffix(layer));
    };
    return fmt::format("function {{ {} }} color_map {{ {} {} }}", part.t, entry(0, part.low),
                       entry(1, part.high));
}

std::string pigment(const Paint& paint, double gain, Layer layer) {
    if (paint.is_constant()) {
        return fmt::format("pigment {{ rgb {}{} }}", pov_color(paint.constant * gain), suffix(layer));
    }
    if (paint.parts.size() == 1) {
        return fmt::format("pigment {{ {} }}", function_map(paint.parts[0], gain, layer));
    }
    std::string text = "pigment { average pigment_map {";
    for (const Paint::Part& part : paint.parts) {
        text += fmt::format(" [1 {}]", function_map(part, 3 * gain, layer));
    }
    return text + " } }";
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

bool has_equal_channels(const Paint& paint) {
    return paint.is_constant() && paint.constant.r == paint.constant.g &&
           paint.constant.g == paint.constant.b;
}

std::string highlight(double specular, double shininess) {
    return fmt::format(" specular {} roughness {}", number(specular), number(1 / shininess));
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

std::string layer_text(const std::string& pigment_text, const std::string& finish_text) {
    return finish_text.empty() ? fmt::format("texture {{ {} }}", pigment_text)
                               : fmt::format("texture {{ {} finish {{{} }} }}", pigment_text, finish_text);
}

/// Layers from the bottom. POV-Ray dims the light of a half transparent layer and of all below it by one
/// half, but not highlights and reflections of the top layer; it has no coloured highlights, so these are
/// white on a black layer at the bottom, under a layer that filters them.
std::vector<std::string> layers_of(const PaintedPhong& phong) {
    const std::vector<Body> bodies = bodies_of(phong);
    const bool colored_highlight = !has_equal_channels(phong.specular);
    std::vector<std::string> layers;
    if (colored_highlight) {
        const double gain = std::exp2(static_cast<double>(bodies.size()));
        layers.push_back(
            layer_text(pigment(Paint{}, 1, Layer::opaque), highlight(1, phong.shininess.constant.r)));
        layers.push_back(layer_text(pigment(phong.specular, gain, Layer::filter), ""));
    }
    for (std::size_t above = bodies.size(); above-- > 0;) {
        const bool bottom = above + 1 == bodies.size() && !colored_highlight;
        const double gain = std::exp2(static_cast<double>(above) + (bottom ? 0 : 1));
        std::string finish = body_finish(bodies[above], gain);
        if (above == 0 && !colored_highlight && !phong.specular.is_black()) {
            finish += highlight(phong.specular.constant.r, phong.shininess.constant.r);
        }
        if (above == 0 && !phong.reflect.is_black()) {
            finish += fmt::format(" reflection {{ rgb {} }}", pov_color(phong.reflect.constant));
        }
        layers.push_back(
            layer_text(pigment(bodies[above].paint, 1, bottom ? Layer::opaque : Layer::half), finish));
    }
    return layers;
}

Paint constant_paint(const Color& color) {
    return {color, {}, false, runtime::no_function};
}

} // namespace

std::string PovTextures::declare(const std::string& name, const PaintedPhong& phong, Outcome& shininess) {
    if (!phong.reflect.is_constant()) {
        return declare_varying_reflect(name, phong, shininess);
    }
    if (!phong.shininess.is_constant() && !phong.specular.is_black()) {
        return declare_varying_shininess(name, phong, shininess);
    }
    return declare_layers(name, phong);
}

/// A finish has a constant reflection; between two textures POV-Ray blends.
std::string PovTextures::declare_varying_reflect(const std::string& name, const PaintedPhong& phong,
                                                 Outcome& shininess) {
    const std::vector<Paint::Part> parts = phong.reflect.parts;
    const auto share = static_cast<double>(parts.size());
    std::vector<std::string> blends;
    for (const Paint::Part& part : parts) {
        std::vector<std::string> ends;
        for (const Color& end : {part.low, part.high}) {
            PaintedPhong fixed = phong;
            fixed.reflect = constant_paint(end * share);
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

std::string PovTextures::declare_varying_shininess(const std::string& name, const PaintedPhong& phong,
                                                   Outcome& shininess) {
    const Paint::Part part = phong.shininess.parts[0];
    const double low = std::max(part.low.r, 1e-3), high = std::max(part.high.r, 1e-3);
    if (low == high) {
        PaintedPhong fixed = phong;
        fixed.shininess = constant_paint({low, low, low});
        return declare_layers(name, fixed);
    }
    // Linear interpolation of x -> c^exp(x) with steps h is off by at most 0.039 h^2, whatever c is.
    const double wanted = std::abs(std::log(high / low)) / std::sqrt(1e-6 / 0.039);
    const int steps = phong.shininess.two_valued
                          ? 1
                          : static_cast<int>(std::clamp(std::ceil(wanted), 1.0, most_map_entries - 1.0));
    std::vector<std::string> stops;
    for (int i = 0; i <= steps; ++i) {
        PaintedPhong fixed = phong;
        const double value = low * std::pow(high / low, static_cast<double>(i) / steps);
        fixed.shininess = constant_paint({value, value, value});
        stops.push_back(declare_layers(name, fixed));
    }
    if (phong.shininess.two_valued) {
        return declare_blend(name, part.t, stops);
    }
    const double step = std::log(high / low) / steps;
    shininess = {Fidelity::approximated,
                 fmt::format("blended between {} textures; bound relative to the highlight", steps + 1),
                 0.039 * step * step};
    const std::string fraction = fmt::format(
        "ln(max({}*({}) + ({}), {})/{})/({})", part.t, number(part.high.r - part.low.r), number(part.low.r),
        number(std::min(low, high)), number(low), number(std::log(high / low)));
    return declare_blend(name, fmt::format("min(max({}, 0), 1)", fraction), stops);
}

std::string PovTextures::declare_blend(const std::string& name, const std::string& t,
                                       const std::vector<std::string>& textures) {
    const std::string blend = names_.make(name);
    out_.line("#declare {} = texture {{", blend);
    out_.indent();
    out_.line("function {{ {} }}", t);
    out_.line("texture_map {{");
    out_.indent();
    for (std::size_t i = 0; i < textures.size(); ++i) {
        const double at = static_cast<double>(i) / static_cast<double>(textures.size() - 1);
        out_.line("[{} {}]", number(at), textures[i]);
    }
    out_.dedent();
    out_.line("}}");
    out_.dedent();
    out_.line("}}");
    return blend;
}

std::string PovTextures::declare_layers(const std::string& name, const PaintedPhong& phong) {
    const std::string identifier = names_.make(name);
    const std::vector<std::string> layers = layers_of(phong);
    if (layers.size() == 1) {
        out_.line("#declare {} = {}", identifier, layers[0]);
        return identifier;
    }
    out_.line("#declare {} =", identifier);
    out_.indent();
    for (const std::string& layer : layers) {
        out_.raw_line(layer);
    }
    out_.dedent();
    return identifier;
}

} // namespace scc::compiler
