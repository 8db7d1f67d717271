#pragma once

#include "lang/value.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

/// Things that differ in numbers only, as loops make them, held as columns of numbers.
namespace scc::lang {

/// Numbers of one place in all things, in the order of the rounds. Not initialised.
class Column {
public:
    explicit Column(std::size_t size);
    double* data() { return numbers_.get(); }
    double operator[](std::size_t round) const { return numbers_[round]; }

private:
    struct Free {
        void operator()(double* numbers) const { std::free(numbers); }
    };
    std::unique_ptr<double[], Free> numbers_;
};

/// Where the things of each round were written, for those that do not all come from the same text.
using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Rounds of a loop. Each made `things`, in which a scalar's symbol is the number of a column.
struct ThingRows {
    std::shared_ptr<const std::vector<Column>> columns;
    std::shared_ptr<const Places> places; ///< null: all have the place of `things`
    std::size_t begin = 0;                ///< the first of these rounds, in the columns
    std::size_t count = 0;
    std::vector<ThingPtr> things; ///< of one round, in order

    double number(const Scalar& scalar, std::size_t round) const {
        return scalar.is_constant() ? scalar.value : (*columns)[scalar.symbol][begin + round];
    }
    Span span(std::size_t thing, std::size_t round) const;
    /// One of the things of a round, as it would be without rows.
    ThingPtr thing(std::size_t thing, std::size_t round) const;
};

/// A thing that stands for all of the rows' things.
ThingPtr make_rows(ThingRows rows);

/// How many things stand in the place of this one.
std::size_t count_of(const Thing& thing);

/// The scalars of the thing that are not known, in the order of its fields.
std::vector<std::uint32_t> symbols_of(const Thing& thing);

/// The thing with these numbers and columns in the place of its unknown scalars; itself if it has none.
/// `with[symbol]` stands for a symbol.
ThingPtr replaced(const ThingPtr& thing, const std::vector<Scalar>& with);

} // namespace scc::lang
