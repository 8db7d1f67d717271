#pragma once

#include "compiler/backends/render.h"
#include "compiler/cli/explain.h"
#include "compiler/cli/explain_names.h"
#include "runtime/explanation.h"

#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <utility>

/// What the explanations of ray and of raster pictures have in common.
namespace scc::cli {

std::string text(double v);
std::string text(const runtime::Vec3<double>& v);
std::string text(const runtime::Rgb<double>& c);
bool is_black(const runtime::Rgb<double>& c);

/// Of a scene with spectra: at the wavelengths of `band`.
runtime::Rgb<double> ambient_of(const compiler::ir::Scene& scene, std::size_t band);
runtime::Rgb<double> background_of(const compiler::ir::Scene& scene, std::size_t band);

/// As for the file that the scene names, unless one is asked for.
compiler::PrecisionChoice choose_precision(const compiler::ir::Scene& scene,
                                           const runtime::RenderRequest& request,
                                           const ExplainOptions& options);
/// Throws host::UsageError for a pixel or sample that the picture does not have.
compiler::PixelPlace place_of_sample(const runtime::RenderSettings& settings, const ExplainOptions& options);

/// Which sample of which picture, and in which arithmetic. Not `is_plain`: the scene asks for other samples
/// or another filter than are explained.
std::string heading(const compiler::ir::Scene& scene, const runtime::RenderSettings& settings,
                    const compiler::PixelPlace& place, const compiler::PrecisionChoice& precision,
                    std::size_t band, bool is_plain);

/// Collects indented lines, and writes how points are lit.
class TermsWriter {
public:
    TermsWriter(Names names, const runtime::Rgb<double>& ambient, bool has_shadows)
        : names_(std::move(names)), ambient_(ambient), has_shadows_(has_shadows) {}

    template <class... T>
    void line(std::size_t depth, fmt::format_string<T...> format, T&&... values) {
        out_ += std::string(2 * depth, ' ') + fmt::format(format, std::forward<T>(values)...) + "\n";
    }
    /// L7, of the point that the ray has met.
    void light(const runtime::RayTerms& ray, std::size_t depth);

    const Names& names() const { return names_; }
    std::string take() { return std::move(out_); }

private:
    void write(const runtime::LightTerms& terms, const runtime::RayTerms& ray, std::size_t depth);
    void write(const runtime::Feeler& feeler, std::size_t depth);

    Names names_;
    runtime::Rgb<double> ambient_;
    bool has_shadows_; ///< that nothing is in a light's way need not be said
    std::string out_;
};

} // namespace scc::cli
