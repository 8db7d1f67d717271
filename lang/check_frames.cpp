#include "lang/imports.h"
#include "lang/wording.h"

/// `frame` and `time`, which a scene has whose `render` has `frames`.
namespace scc::lang {
namespace {

const ast::Construct* render_of(const ast::Item& item) {
    const auto* child = std::get_if<ast::Child>(&item.node);
    const auto* thing = child && child->value ? std::get_if<ast::Construct>(&child->value->node) : nullptr;
    return thing && thing->constructor.text == "render" ? thing : nullptr;
}

bool sets(const ast::Construct& thing, std::string_view name) {
    for (const ast::Item& item : thing.body.items) {
        const auto* field = std::get_if<ast::Field>(&item.node);
        if (field && field->name.text == name) {
            return true;
        }
    }
    return false;
}

const Code* field_code(const code::Construct& thing, std::string_view name) {
    for (const ItemCode& item : thing.body.items) {
        const auto* field = std::get_if<FieldCode>(&item.node);
        if (field && field->field->name == name) {
            return field->value.get();
        }
    }
    return nullptr;
}

} // namespace

/// From the text, since it is known before anything is checked. What would give the scene frames is kept for
/// the names that need it.
void Checker::find_frames(const ast::File& file) {
    constexpr std::string_view example = "frames = 0..48";
    const auto end = static_cast<std::uint32_t>(sources_.file(file.file).text().size());
    session_.frames_fix = Fix{{file.file, end, end}, fmt::format("\nrender {{ {} }}\n", example)};
    bool has_render = false;
    for (const ast::Item& item : file.items) {
        const ast::Construct* render = render_of(item);
        if (!render) {
            continue;
        }
        session_.has_frames = session_.has_frames || sets(*render, "frames");
        if (!has_render && !render->body.is_open) {
            const std::uint32_t inside = render->body.span.begin + 1;
            const bool is_empty = render->body.items.empty();
            session_.frames_fix =
                Fix{{file.file, inside, inside}, fmt::format(" {}{}", example, is_empty ? "" : ",")};
            has_render = true;
        }
    }
}

/// Of the first `render` that has frames.
void Checker::find_frames_code(CheckedFile& file) {
    for (const ItemCode& item : file.body.items) {
        const auto* child = std::get_if<ChildCode>(&item.node);
        const auto* thing = child ? std::get_if<code::Construct>(&child->value->node) : nullptr;
        if (thing && thing->constructor->name == "render" && field_code(*thing, "frames")) {
            file.animated = {thing, field_code(*thing, "frames"), field_code(*thing, "frame_rate")};
            return;
        }
    }
}

bool Checker::is_frame_name(std::string_view name) {
    return name == "frame" || name == "time";
}

Typed Checker::frame_number(std::string_view name, Span span) {
    if (!session_.has_frames) {
        Diagnostic& diagnostic = diagnostics_.report(Diag::frame_without_frames, span, name);
        const Fix& fix = session_.frames_fix;
        const std::string_view text = fix.replacement;
        const std::size_t begin = text.find_first_not_of(" \n");
        const std::size_t end = text.find_last_not_of(" \n,") + 1;
        diagnostic.suggest(fix.span, fix.replacement)
            .note(fix.span, fmt::format("it has them with `{}` here", text.substr(begin, end - begin)));
        return {};
    }
    return {TypeKind::number, make_code(code::FrameNumber{name == "time"}, span)};
}

} // namespace scc::lang
