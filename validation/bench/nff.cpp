#include "validation/bench/nff.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace scc::bench {

namespace {

class NffReader {
public:
    explicit NffReader(std::istream& stream) {
        for (std::string line; std::getline(stream, line);) {
            std::istringstream words(line.substr(0, line.find('#')));
            words_.insert(words_.end(), std::istream_iterator<std::string>(words), {});
        }
    }

    NffScene read() {
        while (at_ < words_.size()) {
            read_entity(words_[at_++]);
        }
        for (const std::size_t i : plain_lights_) {
            const double brightness = 1 / std::sqrt(static_cast<double>(scene_.lights.size()));
            scene_.lights[i].color = {brightness, brightness, brightness};
        }
        return std::move(scene_);
    }

private:
    void read_entity(const std::string& name) {
        if (name == "v") {
            return; // its parts follow by name
        }
        if (name == "b") {
            scene_.background = color();
        } else if (name == "from") {
            scene_.from = vector();
        } else if (name == "at") {
            scene_.at = vector();
        } else if (name == "up") {
            scene_.up = vector();
        } else if (name == "angle") {
            scene_.angle = number();
        } else if (name == "hither") {
            scene_.hither = number();
        } else if (name == "resolution") {
            scene_.width = static_cast<int>(number());
            scene_.height = static_cast<int>(number());
        } else if (name == "l") {
            scene_.lights.push_back({vector(), {}});
            if (next_is_number()) {
                scene_.lights.back().color = color();
            } else {
                plain_lights_.push_back(scene_.lights.size() - 1);
            }
        } else if (name == "f") {
            const Color tint = color();
            const double diffuse = number(), specular = number(), shine = number(), transmission = number();
            scene_.fills.push_back({tint, diffuse, specular, shine, transmission, number()});
        } else if (name == "s") {
            const Vec center = vector();
            scene_.spheres.push_back({center, number(), fill()});
        } else if (name == "c") {
            const Vec base = vector();
            const double base_radius = number();
            const Vec apex = vector();
            scene_.cones.push_back({base, base_radius, apex, number(), fill()});
        } else if (name == "p" || name == "pp") {
            NffPolygon polygon{{}, {}, fill()};
            for (auto left = static_cast<int>(number()); left > 0; --left) {
                polygon.corners.push_back(vector());
                if (name == "pp") {
                    polygon.normals.push_back(vector());
                }
            }
            scene_.polygons.push_back(std::move(polygon));
        } else {
            throw std::runtime_error(fmt::format("NFF has no entity `{}`", name));
        }
    }

    static bool parse(const std::string& word, double& value) {
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc() && end == word.data() + word.size();
    }
    bool next_is_number() const {
        double ignored = 0;
        return at_ < words_.size() && parse(words_[at_], ignored);
    }
    double number() {
        double value = 0;
        if (at_ == words_.size() || !parse(words_[at_], value)) {
            throw std::runtime_error("a number is missing");
        }
        ++at_;
        return value;
    }
    Vec vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }
    Color color() {
        const Vec v = vector();
        return {v.x, v.y, v.z};
    }
    std::size_t fill() const {
        if (scene_.fills.empty()) {
            throw std::runtime_error("a shape comes before the first fill");
        }
        return scene_.fills.size() - 1;
    }

    NffScene scene_;
    std::vector<std::string> words_;
    std::size_t at_ = 0;
    std::vector<std::size_t> plain_lights_;
};

std::string text(const Vec& v) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z);
}
std::string text(const Color& c) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", c.r, c.g, c.b);
}
/// In Tachyon's world, which is left-handed.
std::string mirrored(const Vec& v) {
    return text(Vec{v.x, v.y, -v.z});
}

/// For each shape in the file's order of fills, so that each fill is written once.
template <class Shapes, class F>
void for_shapes_with(const Shapes& shapes, std::size_t fill, F&& f) {
    for (const auto& shape : shapes) {
        if (shape.fill == fill) {
            f(shape);
        }
    }
}

std::ofstream open(const std::filesystem::path& path) {
    std::ofstream file(path);
    if (!file) {
        throw std::runtime_error(fmt::format("cannot write `{}`", path.string()));
    }
    return file;
}

} // namespace

NffScene read_nff(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) {
        throw std::runtime_error(fmt::format("cannot read `{}`", path.string()));
    }
    return NffReader(file).read();
}

void write_nff(const NffScene& scene, const std::filesystem::path& path) {
    std::ofstream file = open(path);
    file << "b " << text(scene.background) << "\nv\nfrom " << text(scene.from) << "\nat " << text(scene.at)
         << "\nup " << text(scene.up) << "\nangle " << scene.angle << "\nhither " << scene.hither
         << "\nresolution " << scene.width << ' ' << scene.height << '\n';
    for (const NffLight& light : scene.lights) {
        file << "l " << text(light.position) << ' ' << text(light.color) << '\n';
    }
    for (std::size_t i = 0; i < scene.fills.size(); ++i) {
        const NffFill& fill = scene.fills[i];
        file << fmt::format("f {} {} {} {} {} {}\n", text(fill.color), fill.diffuse, fill.specular,
                            fill.shine, fill.transmission, fill.index);
        for_shapes_with(scene.spheres, i, [&](const NffSphere& s) {
            file << fmt::format("s {} {:.9g}\n", text(s.center), s.radius);
        });
        for_shapes_with(scene.cones, i, [&](const NffCone& c) {
            file << fmt::format("c\n{} {:.9g}\n{} {:.9g}\n", text(c.base), c.base_radius, text(c.apex),
                                c.apex_radius);
        });
        for_shapes_with(scene.polygons, i, [&](const NffPolygon& p) {
            file << (p.normals.empty() ? "p " : "pp ") << p.corners.size() << '\n';
            for (std::size_t k = 0; k < p.corners.size(); ++k) {
                file << text(p.corners[k]) << (p.normals.empty() ? "" : " " + text(p.normals[k])) << '\n';
            }
        });
    }
}

void write_tachyon(const NffScene& scene, int bounces, const std::filesystem::path& path) {
    std::ofstream file = open(path);
    const Vec view = normalize(scene.at - scene.from);
    const Vec up = normalize(scene.up - view * dot(scene.up, view));
    const double half_height = std::tan(scene.angle / 360 * std::numbers::pi);
    file << fmt::format("Begin_Scene\nResolution {} {}\n", scene.width, scene.height)
         << fmt::format("Camera\n  Projection Perspective\n  Zoom {:.9g}\n  Aspectratio 1\n  Antialiasing 0\n"
                        "  Raydepth {}\n  Center {}\n  Viewdir {}\n  Updir {}\nEnd_Camera\n",
                        0.5 / half_height, bounces + 1, mirrored(scene.from), mirrored(view), mirrored(up))
         << "Background " << text(scene.background) << '\n';
    for (const NffLight& light : scene.lights) {
        file << fmt::format("Light Center {} Rad 0.001 Color {}\n", mirrored(light.position),
                            text(light.color));
    }
    for (std::size_t i = 0; i < scene.fills.size(); ++i) {
        const NffFill& fill = scene.fills[i];
        file << fmt::format("TexDef fill{} Ambient {} Diffuse {} Specular {} Opacity {} Phong Plastic {} "
                            "Phong_size {} Color {} TexFunc 0\n",
                            i, 0.1 * fill.diffuse, fill.diffuse, fill.specular, 1 - fill.transmission,
                            fill.specular, std::max(fill.shine, 1.0), text(fill.color));
    }
    for (const NffSphere& s : scene.spheres) {
        file << fmt::format("Sphere Center {} Rad {:.9g} fill{}\n", mirrored(s.center), s.radius, s.fill);
    }
    for (const NffCone& c : scene.cones) {
        file << fmt::format("FCylinder Base {} Apex {} Rad {:.9g} fill{}\n", mirrored(c.base),
                            mirrored(c.apex), (c.base_radius + c.apex_radius) / 2, c.fill);
    }
    for (const NffPolygon& p : scene.polygons) {
        for (std::size_t k = 2; k < p.corners.size(); ++k) {
            file << fmt::format("{} V0 {} V1 {} V2 {}", p.normals.empty() ? "Tri" : "STri",
                                mirrored(p.corners[0]), mirrored(p.corners[k - 1]), mirrored(p.corners[k]));
            if (!p.normals.empty()) {
                file << fmt::format(" N0 {} N1 {} N2 {}", mirrored(p.normals[0]), mirrored(p.normals[k - 1]),
                                    mirrored(p.normals[k]));
            }
            file << fmt::format(" fill{}\n", p.fill);
        }
    }
    file << "End_Scene\n";
}

} // namespace scc::bench
