#include "lang/rows.h"

#include <algorithm>
#include <new>
#include <sys/mman.h>
#include <type_traits>

namespace scc::lang {
namespace {

/// Calls `visit(Scalar&)` for each scalar of a value that is its own; `on_thing(ThingPtr&)`,
/// `on_list(ListPtr&)` and `on_spectra(SpectralPart&)` for what it shares with others.
template <class V, class Visit, class OnThing, class OnList, class OnSpectra>
void for_parts(V& value, const Visit& visit, const OnThing& on_thing, const OnList& on_list,
               const OnSpectra& on_spectra) {
    std::visit(
        [&](auto& v) {
            using T = std::remove_cvref_t<decltype(v)>;
            if constexpr (std::is_same_v<T, NumberValue> || std::is_same_v<T, BoolValue>) {
                visit(v.v);
            } else if constexpr (std::is_same_v<T, AngleValue>) {
                visit(v.radians);
            } else if constexpr (std::is_same_v<T, Vec2Value> || std::is_same_v<T, Vec3Value> ||
                                 std::is_same_v<T, ColorValue>) {
                for (auto& component : v.v) {
                    visit(component);
                }
                if constexpr (std::is_same_v<T, ColorValue>) {
                    if (v.spectral) {
                        on_spectra(v.spectral);
                    }
                }
            } else if constexpr (std::is_same_v<T, ThingPtr>) {
                on_thing(v);
            } else if constexpr (std::is_same_v<T, ListPtr>) {
                on_list(v);
            }
        },
        value.v);
}

template <class Visit>
void for_each_scalar(const Value& value, const Visit& visit);

template <class Visit>
void for_each_scalar(const Thing& thing, const Visit& visit) {
    for (const FieldValue& field : thing.fields) {
        for_each_scalar(field.value, visit);
    }
}

template <class Visit>
void for_each_scalar(const Value& value, const Visit& visit) {
    for_parts(
        value, visit, [&](const ThingPtr& thing) { for_each_scalar(*thing, visit); },
        [&](const ListPtr& list) {
            for (const Value& element : *list) {
                for_each_scalar(element, visit);
            }
        },
        [&](const SpectralPart& spectra) {
            for (const SpectralTerm& term : *spectra) {
                visit(term.factor);
            }
        });
}

template <class Part>
bool is_known(const Part& part) {
    bool known = true;
    for_each_scalar(part, [&](const Scalar& scalar) { known = known && scalar.is_constant(); });
    return known;
}

void replace(Value& value, const std::vector<Scalar>& with) {
    const auto replace_scalar = [&](Scalar& scalar) {
        if (!scalar.is_constant()) {
            scalar = with[scalar.symbol];
        }
    };
    for_parts(
        value, replace_scalar, [&](ThingPtr& thing) { thing = replaced(thing, with); },
        [&](ListPtr& list) {
            if (!std::all_of(list->begin(), list->end(), [](const Value& v) { return is_known(v); })) {
                auto copy = std::make_shared<std::vector<Value>>(*list);
                for (Value& element : *copy) {
                    replace(element, with);
                }
                list = std::move(copy);
            }
        },
        [&](SpectralPart& spectra) {
            auto copy = std::make_shared<std::vector<SpectralTerm>>(*spectra);
            for (SpectralTerm& term : *copy) {
                replace_scalar(term.factor);
            }
            spectra = std::move(copy);
        });
}

} // namespace

/// Long columns get large pages where the system has them: millions of small ones take longer to be had than
/// their numbers to be computed.
Column::Column(std::size_t size) {
    constexpr std::size_t large_page = std::size_t{1} << 21U;
    const std::size_t bytes = std::max(size, std::size_t{1}) * sizeof(double);
    const std::size_t page = bytes >= large_page ? large_page : alignof(std::max_align_t);
    const std::size_t whole = (bytes + page - 1) / page * page;
    numbers_.reset(static_cast<double*>(std::aligned_alloc(page, whole)));
    if (!numbers_) {
        throw std::bad_alloc();
    }
#ifdef MADV_HUGEPAGE
    if (page == large_page) {
        madvise(numbers_.get(), whole, MADV_HUGEPAGE);
    }
#endif
}

std::vector<std::uint32_t> symbols_of(const Thing& thing) {
    std::vector<std::uint32_t> symbols;
    for_each_scalar(thing, [&](const Scalar& scalar) {
        if (!scalar.is_constant()) {
            symbols.push_back(scalar.symbol);
        }
    });
    return symbols;
}

ThingPtr replaced(const ThingPtr& thing, const std::vector<Scalar>& with) {
    if (is_known(*thing)) {
        return thing;
    }
    auto copy = std::make_shared<Thing>(*thing);
    for (FieldValue& field : copy->fields) {
        replace(field.value, with);
    }
    return copy;
}

Span ThingRows::span(std::size_t thing, std::size_t round) const {
    Span span = things[thing]->span;
    if (places) {
        std::tie(span.begin, span.end) = (*places)[begin + round];
    }
    return span;
}

ThingPtr ThingRows::thing(std::size_t thing, std::size_t round) const {
    std::vector<Scalar> numbers;
    for (const Column& column : *columns) {
        numbers.push_back({column[begin + round]});
    }
    ThingPtr made = replaced(things[thing], numbers);
    if (places) {
        auto placed = std::make_shared<Thing>(*made);
        placed->span = span(thing, round);
        made = std::move(placed);
    }
    return made;
}

ThingPtr make_rows(ThingRows rows) {
    auto thing = std::make_shared<Thing>();
    thing->constructor = rows.things.front()->constructor;
    thing->span = rows.things.front()->span;
    for (const ThingPtr& one : rows.things) {
        thing->height = std::max(thing->height, one->height);
    }
    thing->rows = std::make_shared<const ThingRows>(std::move(rows));
    return thing;
}

std::size_t count_of(const Thing& thing) {
    return thing.rows ? thing.rows->count * thing.rows->things.size() : 1;
}

} // namespace scc::lang
