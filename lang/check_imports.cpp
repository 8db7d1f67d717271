#include "lang/imports.h"
#include "lang/parser.h"
#include "lang/units.h"
#include "lang/wording.h"

#include <algorithm>

namespace scc::lang {
namespace {

constexpr std::string_view whole_scene = "scene"; // `name.scene`

/// What an item of `with` is that sets no param.
std::string_view described(const ast::Item& item) {
    const auto is = [&]<class Node>(std::type_identity<Node>) {
        return std::holds_alternative<Node>(item.node);
    };
    return is(std::type_identity<ast::Let>{})        ? "a `let`"
           : is(std::type_identity<ast::Function>{}) ? "a `fn`"
           : is(std::type_identity<ast::Param>{})    ? "a `param`"
           : is(std::type_identity<ast::Import>{})   ? "an `import`"
           : is(std::type_identity<ast::For>{})      ? "a loop"
           : is(std::type_identity<ast::If>{})       ? "a condition"
                                                     : "an expression";
}

} // namespace

CheckedFile::CheckedFile() = default;
CheckedFile::CheckedFile(CheckedFile&&) noexcept = default;
CheckedFile& CheckedFile::operator=(CheckedFile&&) noexcept = default;
CheckedFile::~CheckedFile() = default;

Checker::Checker(const Schema& schema, SourceSet& sources, Diagnostics& diagnostics,
                 const EvaluationLimits& limits, ImportSession& session, SymbolIndex* symbols)
    : schema_(schema), sources_(sources), diagnostics_(diagnostics), limits_(limits), session_(session),
      names_(diagnostics), symbols_(symbols) {}

/// Of a file that another one imports, and whose unit it counts in unless it has its own.
Checker::Checker(Importing importing)
    : Checker(importing.checker.schema_, importing.checker.sources_, importing.checker.diagnostics_,
              importing.checker.limits_, importing.checker.session_) {
    is_imported_ = true;
    world_unit_ = importing.checker.world_unit_;
}

Checker::~Checker() = default;

/// Checks the imported file, all of it, and keeps its names. What `with` gives is checked with the items.
void Checker::import_file(const ast::Import& item, Binding& binding) {
    auto file = std::make_unique<ImportedFile>();
    file->name = item.alias.text;
    file->span = item.alias.span;
    file->group = schema_.find(schema_.group);
    const ast::File* tree = open_import(item, *file);
    if (!tree) {
        import_failed_ = true;
        return;
    }
    imported_.emplace_back(new ImportedNames{Checker(Importing{*this}), file.get()});
    ImportedNames& names = *imported_.back();
    file->code = names.checker.run(*tree, {});
    session_.open.pop_back();
    if (names.checker.world_unit_ != world_unit_) {
        const ast::Unit theirs = names.checker.world_unit_;
        diagnostics_.report(Diag::unit_differs, item.path->span, sources_.text(item.path->span),
                            name_of(theirs), name_of(world_unit_), in_world_units(1, theirs, world_unit_));
    }
    binding.imported = &names;
    imports_.push_back(std::move(file));
}

/// The tree of the file, which is open from now on; null if there is none, which is reported.
const ast::File* Checker::open_import(const ast::Import& item, ImportedFile& file) {
    const auto* name = std::get_if<ast::String>(&item.path->node);
    if (!name) { // could not be read
        return nullptr;
    }
    const Span place = item.path->span;
    const std::string quoted = in_code(name->value);
    if (!session_.importer) {
        diagnostics_.report(Diag::unreadable_import, place, quoted, "there are no files here");
        return nullptr;
    }
    if (session_.open.size() > limits_.import_depth) {
        diagnostics_.report(Diag::nesting_too_deep, place, limits_.import_depth);
        return nullptr;
    }
    if (++session_.count > limits_.imports) {
        if (session_.count == limits_.imports + 1) {
            diagnostics_.report(Diag::too_many_imports, place, limits_.imports);
        }
        return nullptr;
    }
    const std::string& from = sources_.file(place.file).path();
    const ImportTarget target = session_.importer->find(from, name->value);
    if (target.status == ImportTarget::Status::outside) {
        diagnostics_.report(Diag::import_outside, place, quoted);
        return nullptr;
    }
    if (target.status == ImportTarget::Status::missing) {
        diagnostics_.report(Diag::unreadable_import, place, quoted, target.problem);
        return nullptr;
    }
    for (std::size_t i = 0; i < session_.open.size(); ++i) {
        if (session_.open[i].identity == target.identity) {
            report_import_cycle(i, place);
            return nullptr;
        }
    }
    auto found = session_.trees.find(target.identity);
    if (found == session_.trees.end()) {
        ImportText text = session_.importer->read(target);
        if (!text.problem.empty()) {
            diagnostics_.report(Diag::unreadable_import, place, quoted, text.problem);
            return nullptr;
        }
        const FileId id = sources_.add(target.path, std::move(text.text));
        found = session_.trees.emplace(target.identity, ImportSession::Tree{id, nullptr}).first;
        diagnostics_.imported(id, place);
        found->second.tree = read_file(sources_, id, diagnostics_);
    }
    diagnostics_.imported(found->second.file, place);
    session_.open.push_back({target.identity, target.path, place});
    file.tree = found->second.tree;
    return file.tree.get();
}

/// `first` is the open file that is imported once more at `span`.
void Checker::report_import_cycle(std::size_t first, Span span) {
    const auto& open = session_.open;
    Diagnostic& diagnostic = diagnostics_.report(Diag::cyclic_import, span, open[first].path);
    for (std::size_t i = first; i < open.size(); ++i) {
        const bool is_last = i + 1 == open.size();
        diagnostic.note(is_last ? span : open[i + 1].import,
                        fmt::format("`{}` imports `{}` here", open[i].path,
                                    is_last ? open[first].path : open[i + 1].path));
    }
}

void Checker::item(const ast::Import& item, Span span, const Into& into) {
    if (!into.around.at_top) {
        misplaced(span, "an `import`", into.around);
        if (item.with) {
            unknown_body(*item.with, into.place);
        }
        return;
    }
    const auto binding = file_scope_->names.find(item.alias.text);
    const bool is_known = binding != file_scope_->names.end() && binding->second->span == item.alias.span &&
                          binding->second->imported;
    if (item.with && !is_known) { // its values use names of this file
        unknown_body(*item.with, into.place);
    } else if (item.with) {
        std::vector<const ast::Field*> seen;
        for (const ast::Item& written : item.with->items) {
            const auto* field = std::get_if<ast::Field>(&written.node);
            if (!field) {
                diagnostics_.report(Diag::unexpected_item, written.span, "`with`", "`param = value`",
                                    described(written));
                continue;
            }
            const auto first = std::find_if(seen.begin(), seen.end(), [&](const ast::Field* earlier) {
                return earlier->name.text == field->name.text;
            });
            if (first != seen.end()) {
                diagnostics_.report(Diag::duplicate_field, field->name.span, field->name.text)
                    .note((*first)->name.span, "it is set here");
                continue;
            }
            seen.push_back(field);
            given_param(*field, *binding->second, into.place);
        }
    }
}

/// One `param = value` of `with`.
void Checker::given_param(const ast::Field& item, Binding& binding, const Place& place) {
    Typed value = expression(item.value, {place.scope, &binding, {}});
    CheckedFile& file = binding.imported->file->code;
    std::vector<std::string_view> names;
    for (ParamCode& param : file.params) {
        if (param.name != item.name.text) {
            names.push_back(param.name);
            continue;
        }
        if (item.value) {
            expect(fmt::format("the param `{}`", param.name), param.type, value, *item.value);
            set_param(file, param, make_code(code::Given{std::move(value.code)}, item.value->span));
        }
        return;
    }
    if (item.name.text.empty() || binding.imported->checker.is_lost(item.name.text)) {
        return;
    }
    const auto best = nearest(item.name.text, names);
    Diagnostic& diagnostic = diagnostics_.report(Diag::unknown_import_param, item.name.span,
                                                 in_code(binding.name), item.name.text, did_you_mean(best));
    if (best) {
        diagnostic.suggest(item.name.span, std::string(*best));
    }
}

Binding* Checker::import_named(const ast::Expr& expr, const Place& place) {
    const auto* name = std::get_if<ast::NameRef>(&expr.node);
    Binding* binding = name ? Names::find(place.scope, name->name) : nullptr;
    if (!binding || binding->kind != Binding::Kind::import) {
        return nullptr;
    }
    mention(binding->span, expr.span, place);
    return binding;
}

/// What the imported file binds to the name; null if it could not be read or binds nothing to it.
Binding* Checker::imported_binding(Binding& import, const ast::Name& name, const Place& place) {
    Names::note_use(import, name.span, place.owner);
    if (!import.imported) {
        return nullptr;
    }
    const auto& names = import.imported->checker.file_scope_->names;
    const auto found = names.find(name.text);
    const bool is_value = found != names.end() && found->second->kind != Binding::Kind::import;
    return is_value ? found->second : nullptr;
}

Typed Checker::imported_value(const Binding& import, const Binding& binding, Span span) {
    Typed value = value_of(binding, 0, span);
    if (value.code) {
        value.code = make_code(code::Imported{import.imported->file, std::move(value.code)}, span);
    }
    return value;
}

Typed Checker::imported_member(Binding& import, const ast::Name& name, Span span, const Place& place) {
    const Binding* binding = imported_binding(import, name, place);
    if (!import.imported || name.text.empty()) {
        return {};
    }
    if (name.text == whole_scene) {
        return {TypeKind::scene, make_code(code::ImportedScene{import.imported->file}, span)};
    }
    if (binding) {
        return imported_value(import, *binding, span);
    }
    if (import.imported->checker.is_lost(name.text)) {
        return {};
    }
    std::vector<std::string_view> names{whole_scene};
    for (const auto& [known, other] : import.imported->checker.file_scope_->names) {
        if (other->kind != Binding::Kind::import) {
            names.push_back(known);
        }
    }
    std::sort(names.begin(), names.end()); // as they are hashed
    unknown_member(in_code(import.name), name, names);
    return {};
}

} // namespace scc::lang
