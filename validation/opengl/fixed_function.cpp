#include "validation/opengl/fixed_function.h"

#include "runtime/raster/corners.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <type_traits>
#include <utility>

namespace scc::validation {

namespace {

using runtime::Camera;
using runtime::LineSegment;
using runtime::Phong;
using runtime::Projection;
using runtime::RasterModel;
using runtime::RasterSurface;
using runtime::RenderSettings;
using runtime::Rgb;
using runtime::Vec3;
using Scene = runtime::DynamicScene<double>;

constexpr std::size_t most_lights = 8;
constexpr double most_shininess = 128;

struct DestroyContext {
    void operator()(OSMesaContext context) const { OSMesaDestroyContext(context); }
};
using Context = std::unique_ptr<std::remove_pointer_t<OSMesaContext>, DestroyContext>;

std::array<float, 4> numbers(const Rgb<double>& c, double fourth) {
    return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b),
            static_cast<float>(fourth)};
}
std::array<float, 4> numbers(const Vec3<double>& v, double fourth) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(fourth)};
}

/// The frustum's or box's sides at distance 1, in the pixels' own shape.
struct Window {
    double left, right, bottom, top;
};
Window window_of(const Camera<double>& camera, const RenderSettings& settings) {
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const double half_pixel = settings.point == runtime::PixelPoint::corner ? 1.0 / settings.height : 0;
    const double x = 2 * camera.shift_x - half_pixel, y = 2 * camera.shift_y - half_pixel;
    const double h = camera.half_height;
    return {h * (x - aspect), h * (x + aspect), h * (y - 1), h * (y + 1)};
}

void set_camera(const Camera<double>& camera, const RenderSettings& settings) {
    const Window w = window_of(camera, settings);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    if (camera.projection == Projection::orthographic) {
        glOrtho(w.left, w.right, w.bottom, w.top, camera.near, camera.far);
    } else {
        const double n = camera.near;
        glFrustum(w.left * n, w.right * n, w.bottom * n, w.top * n, n, camera.far);
    }
    glMatrixMode(GL_MODELVIEW);
    const auto &u = camera.u, &v = camera.v, &n = camera.n;
    const std::array<double, 16> view{u.x,
                                      v.x,
                                      n.x,
                                      0,
                                      u.y,
                                      v.y,
                                      n.y,
                                      0,
                                      u.z,
                                      v.z,
                                      n.z,
                                      0,
                                      -dot(u, camera.eye),
                                      -dot(v, camera.eye),
                                      -dot(n, camera.eye),
                                      1};
    glLoadMatrixd(view.data());
}

void set_lights(const Scene& scene) {
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, numbers(scene.ambient, 1).data());
    // Seen from far away, all ways to the viewer are the same.
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, scene.camera.projection == Projection::orthographic ? 0 : 1);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, 1);
    GLenum light = GL_LIGHT0;
    const auto add = [&](const std::array<float, 4>& position, const auto& source) {
        glEnable(light);
        glLightfv(light, GL_POSITION, position.data());
        glLightfv(light, GL_AMBIENT, std::array<float, 4>{0, 0, 0, 1}.data());
        glLightfv(light, GL_DIFFUSE, numbers(source.diffuse, 1).data());
        glLightfv(light, GL_SPECULAR, numbers(source.specular, 1).data());
        ++light;
    };
    const auto add_point = [&](const auto& point) {
        add(numbers(point.position, 1), point);
        glLightf(light - 1, GL_CONSTANT_ATTENUATION, static_cast<float>(point.kc));
        glLightf(light - 1, GL_LINEAR_ATTENUATION, static_cast<float>(point.kl));
        glLightf(light - 1, GL_QUADRATIC_ATTENUATION, static_cast<float>(point.kq));
    };
    for (const auto& point : scene.point_lights) {
        add_point(point);
    }
    for (const auto& spot : scene.spot_lights) {
        add_point(spot);
        glLightfv(light - 1, GL_SPOT_DIRECTION, numbers(spot.axis, 0).data());
        glLightf(light - 1, GL_SPOT_CUTOFF,
                 static_cast<float>(std::acos(spot.cos_outer) * 180 / std::numbers::pi));
        glLightf(light - 1, GL_SPOT_EXPONENT, static_cast<float>(spot.exponent));
    }
    for (const auto& rectangle : scene.rectangle_lights) {
        for_each_point(rectangle, add_point);
    }
    for (const auto& directional : scene.directional_lights) {
        add(numbers(directional.to_light, 0), directional);
    }
}

/// Colours have their opacity in them already; alpha is what is behind that is lost.
void set_material(GLenum side, const Phong<double>& material) {
    const double alpha = 1 - material.transmit.value.r;
    glMaterialfv(side, GL_AMBIENT, numbers(material.ambient.value, alpha).data());
    glMaterialfv(side, GL_DIFFUSE, numbers(material.diffuse.value, alpha).data());
    glMaterialfv(side, GL_SPECULAR, numbers(material.specular.value, alpha).data());
    glMaterialfv(side, GL_EMISSION, numbers(material.emission.value, alpha).data());
    glMaterialf(side, GL_SHININESS, static_cast<float>(material.shininess.value));
}

struct Ordered {
    const RasterSurface<double>* surface;
    std::uint32_t triangle;
    double distance; ///< of the farthest corner, along the view axis
};

class Painter {
public:
    Painter(const Scene& scene, const RasterModel<double>& model) : scene_(scene), model_(model) {}

    void draw_opaque() {
        for (const RasterSurface<double>& surface : model_.surfaces) {
            if (!lets_light_through(surface)) {
                for (std::uint32_t i = 0; i < surface.count; ++i) {
                    draw(surface, i);
                }
            }
        }
        end();
    }
    /// From the farthest to the nearest: right where triangles do not cross each other.
    void draw_transparent() {
        std::vector<Ordered> order;
        for (const RasterSurface<double>& surface : model_.surfaces) {
            if (lets_light_through(surface)) {
                for (std::uint32_t i = 0; i < surface.count; ++i) {
                    order.push_back({&surface, i, farthest(surface, i)});
                }
            }
        }
        std::stable_sort(order.begin(), order.end(),
                         [](const Ordered& a, const Ordered& b) { return a.distance > b.distance; });
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        for (const Ordered& one : order) {
            draw(*one.surface, one.triangle);
        }
        end();
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }
    void draw_lines(int samples_across) {
        glDisable(GL_LIGHTING);
        for (const LineSegment<double>& line : model_.segments) {
            glLineWidth(static_cast<float>(line.width * samples_across));
            glBegin(GL_LINES);
            glColor4fv(numbers(line.color, 1).data());
            glVertex3d(line.from.x, line.from.y, line.from.z);
            glVertex3d(line.to.x, line.to.y, line.to.z);
            glEnd();
        }
        glEnable(GL_LIGHTING);
    }

private:
    bool lets_light_through(const RasterSurface<double>& surface) const {
        return runtime::lets_through(scene_.materials[surface.sides.front]) ||
               runtime::lets_through(scene_.materials[surface.sides.back]);
    }
    double farthest(const RasterSurface<double>& surface, std::uint32_t i) const {
        double distance = -std::numeric_limits<double>::infinity();
        for (const auto& corner :
             runtime::raster::world_triangle(model_, scene_.meshes, surface, i).corners) {
            distance = std::max(distance, -dot(corner - scene_.camera.eye, scene_.camera.n));
        }
        return distance;
    }
    void draw(const RasterSurface<double>& surface, std::uint32_t i) {
        if (current_ != &surface) {
            end();
            glFinish(); // else Mesa keeps materials with the vertices, and mixes those of two sides up
            set_material(GL_FRONT, scene_.materials[surface.sides.front]);
            set_material(GL_BACK, scene_.materials[surface.sides.back]);
            glFinish();
            glFrontFace(surface.is_mirrored ? GL_CW : GL_CCW);
            glBegin(GL_TRIANGLES);
            current_ = &surface;
        }
        const auto triangle = runtime::raster::world_triangle(model_, scene_.meshes, surface, i);
        const auto normals = runtime::raster::world_normals(model_, scene_.meshes, surface, i);
        const auto& c = triangle.corners;
        const Vec3<double> geometric =
            normalize(cross(c[1] - c[0], c[2] - c[0])) * (surface.is_mirrored ? -1.0 : 1.0);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3<double> n = normals[k] == Vec3<double>{} ? geometric : normalize(normals[k]);
            glNormal3d(n.x, n.y, n.z);
            glVertex3d(c[k].x, c[k].y, c[k].z);
        }
    }
    void end() {
        if (std::exchange(current_, nullptr) != nullptr) {
            glEnd();
        }
    }

    const Scene& scene_;
    const RasterModel<double>& model_;
    const RasterSurface<double>* current_ = nullptr; ///< whose triangles are being given
};

void set_state(const Scene& scene, const RenderSettings& settings, int width, int height) {
    glClampColor(GL_CLAMP_VERTEX_COLOR, GL_FALSE);
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glShadeModel(settings.raster.shading == runtime::RasterShading::flat ? GL_FLAT : GL_SMOOTH);
    if (settings.raster.cull == runtime::Cull::back) {
        glEnable(GL_CULL_FACE);
    }
    set_camera(scene.camera, settings);
    set_lights(scene);
    const auto background = numbers(scene.background, 1);
    glClearColor(background[0], background[1], background[2], background[3]);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

/// OpenGL's rows run from the bottom.
void read_back(const std::vector<float>& colors, const std::vector<std::uint32_t>& depths, int n,
               OpenGlPicture& picture) {
    const int width = picture.image.width, height = picture.image.height, across = width * n;
    const auto at = [&](int column, int row) {
        return static_cast<std::size_t>(height * n - 1 - row) * static_cast<std::size_t>(across) +
               static_cast<std::size_t>(column);
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                double sum = 0;
                for (int k = 0; k < n * n; ++k) {
                    sum += static_cast<double>(colors[4 * at(x * n + k % n, y * n + k / n) + channel]);
                }
                picture.image.at(x, y)[channel] = static_cast<float>(sum / (n * n));
            }
            const double window_depth =
                depths[at(x * n + n / 2, y * n + n / 2)] / double(std::numeric_limits<std::uint32_t>::max());
            picture.depth.push_back(2 * window_depth - 1);
        }
    }
}

} // namespace

std::string unsupported_by_opengl(const Scene& scene, const RasterModel<double>& model,
                                  const RenderSettings& settings) {
    using runtime::RasterShading;
    if (settings.raster.shading != RasterShading::flat && settings.raster.shading != RasterShading::gouraud) {
        return "OpenGL's fixed functions shade flat or by vertices";
    }
    if (!settings.raster.clip) {
        return "OpenGL always clips at the near and the far plane";
    }
    if (scene.camera.projection == Projection::spherical || scene.camera.lens_radius > 0) {
        return "the camera is none of OpenGL's";
    }
    std::size_t lights =
        scene.point_lights.size() + scene.directional_lights.size() + scene.spot_lights.size();
    for (const auto& rectangle : scene.rectangle_lights) {
        lights += std::size_t{rectangle.nu} * rectangle.nv;
    }
    if (lights > most_lights) {
        return "OpenGL has at most 8 lights, of which a rectangle takes one for each point of its grid";
    }
    for (const auto& spot : scene.spot_lights) {
        if (spot.cos_inner != spot.cos_outer || spot.exponent > most_shininess) {
            return "OpenGL's cones have hard edges and exponents up to 128";
        }
    }
    for (const RasterSurface<double>& surface : model.surfaces) {
        if (surface.at_infinity) {
            return "planes without end have no vertices that OpenGL could light";
        }
    }
    for (const Phong<double>& m : scene.materials) {
        for (const auto* field : {&m.ambient, &m.diffuse, &m.specular, &m.emission, &m.transmit}) {
            if (field->function != runtime::no_function) {
                return "a material varies from place to place";
            }
        }
        if (m.shininess.function != runtime::no_function || m.shininess.value > most_shininess) {
            return "OpenGL's highlights have exponents up to 128";
        }
        if (!(m.transmit.value.r == m.transmit.value.g && m.transmit.value.g == m.transmit.value.b)) {
            return "OpenGL's alpha has no colour";
        }
    }
    return "";
}

OpenGlPicture draw_by_opengl(const Scene& scene, const RasterModel<double>& model,
                             const RenderSettings& settings) {
    OpenGlPicture picture;
    picture.error = unsupported_by_opengl(scene, model, settings);
    if (!picture.error.empty()) {
        return picture;
    }
    const int n = runtime::samples_per_axis(settings), width = settings.width * n,
              height = settings.height * n;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<float> colors(4 * pixels);
    const Context context(OSMesaCreateContextExt(OSMESA_RGBA, 32, 0, 0, nullptr));
    if (context == nullptr ||
        OSMesaMakeCurrent(context.get(), colors.data(), GL_FLOAT, width, height) == GL_FALSE) {
        picture.error = "Mesa cannot draw a picture of this size without a display";
        return picture;
    }
    set_state(scene, settings, width, height);
    Painter painter(scene, model);
    painter.draw_opaque();
    painter.draw_lines(n);
    painter.draw_transparent();
    glFinish();
    std::vector<std::uint32_t> depths(pixels);
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, depths.data());
    if (glGetError() != GL_NO_ERROR) {
        picture.error = "OpenGL reports an error";
        return picture;
    }
    picture.image = runtime::Image(settings.width, settings.height);
    read_back(colors, depths, n, picture);
    return picture;
}

} // namespace scc::validation
