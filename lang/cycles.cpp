#include "lang/scope.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace scc::lang {
namespace {

/// Tarjan's algorithm for strongly connected components, with a stack of its own: chains of definitions are
/// as long as a file.
class Components {
public:
    explicit Components(std::deque<Binding>& bindings) {
        for (Binding& binding : bindings) {
            if (!visits_.contains(&binding)) {
                run(binding);
            }
        }
    }

    const std::vector<std::vector<Binding*>>& cyclic() const { return cyclic_; }

private:
    struct Visit {
        std::size_t index = 0;
        std::size_t low = 0;
        bool open = true; ///< its component is not complete
    };
    struct Step {
        Binding* binding;
        std::size_t next_use;
    };

    void enter(Binding& binding) {
        visits_[&binding] = {visits_.size(), visits_.size(), true};
        open_.push_back(&binding);
        steps_.push_back({&binding, 0});
    }

    void run(Binding& root) {
        enter(root);
        while (!steps_.empty()) {
            Step& step = steps_.back();
            if (step.next_use == step.binding->uses.size()) {
                leave();
                continue;
            }
            Binding& target = *step.binding->uses[step.next_use++].target;
            const auto seen = visits_.find(&target);
            if (seen == visits_.end()) {
                enter(target);
            } else if (seen->second.open) {
                Visit& visit = visits_.at(step.binding);
                visit.low = std::min(visit.low, seen->second.index);
            }
        }
    }

    void leave() {
        Binding* binding = steps_.back().binding;
        steps_.pop_back();
        const Visit visit = visits_.at(binding);
        if (!steps_.empty()) {
            Visit& above = visits_.at(steps_.back().binding);
            above.low = std::min(above.low, visit.low);
        }
        if (visit.low == visit.index) {
            close_component(binding);
        }
    }

    void close_component(Binding* root) {
        std::vector<Binding*> members;
        do {
            members.push_back(open_.back());
            open_.pop_back();
            visits_.at(members.back()).open = false;
        } while (members.back() != root);
        const bool uses_itself = std::any_of(root->uses.begin(), root->uses.end(),
                                             [root](const Use& use) { return use.target == root; });
        if (members.size() > 1 || uses_itself) {
            cyclic_.push_back(std::move(members));
        }
    }

    std::unordered_map<Binding*, Visit> visits_;
    std::vector<Binding*> open_;
    std::vector<Step> steps_;
    std::vector<std::vector<Binding*>> cyclic_;
};

/// A shortest way of uses from a definition back to itself within its component.
std::vector<std::pair<Binding*, Span>> way_round(Binding* start, const std::vector<Binding*>& members) {
    const std::unordered_set<const Binding*> component(members.begin(), members.end());
    std::unordered_map<Binding*, std::pair<Binding*, Span>> reached_from;
    std::deque<Binding*> queue{start};
    while (!queue.empty() && !reached_from.contains(start)) {
        Binding* binding = queue.front();
        queue.pop_front();
        for (const Use& use : binding->uses) {
            if (component.contains(use.target) &&
                reached_from.try_emplace(use.target, binding, use.span).second) {
                queue.push_back(use.target);
            }
        }
    }
    std::vector<std::pair<Binding*, Span>> way;
    Binding* binding = start;
    do {
        way.push_back({binding, reached_from.at(binding).second});
        binding = reached_from.at(binding).first;
    } while (binding != start);
    std::reverse(way.begin(), way.end());
    return way;
}

Binding* first_value(const std::vector<Binding*>& members) {
    Binding* first = nullptr;
    for (Binding* member : members) {
        const bool is_value = member->kind != Binding::Kind::function;
        if (is_value && (!first || member->span.begin < first->span.begin)) {
            first = member;
        }
    }
    return first;
}

} // namespace

void Names::report_cycle(Binding* first, const std::vector<Binding*>& members) {
    constexpr std::size_t most_notes = 8;
    Diagnostic& diagnostic = diagnostics_.report(Diag::cyclic_definition, first->span, first->name);
    const auto way = way_round(first, members);
    for (std::size_t i = 0; i < std::min(way.size(), most_notes); ++i) {
        diagnostic.note(way[i].second, fmt::format("which needs `{}` here", way[i].first->name));
    }
}

void Names::report_cycles() {
    const Components components(bindings_);
    for (const std::vector<Binding*>& members : components.cyclic()) {
        if (Binding* value = first_value(members)) {
            report_cycle(value, members);
            continue;
        }
        for (const Binding* member : members) {
            if (member->needs_result_type) {
                diagnostics_.report(Diag::result_type_needed, member->span, member->name);
            }
        }
    }
}

} // namespace scc::lang
