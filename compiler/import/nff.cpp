#include "compiler/import/nff.h"

#include "compiler/shape_rules.h"
#include "lang/utf8.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

namespace scc::compiler::nff {

namespace {

// More than any outline that someone drew; cutting ears off takes time with the square.
constexpr std::int64_t most_corners = 1 << 14;
constexpr int largest_size = 1 << 16;
// Products of two such numbers are finite.
constexpr double largest_number = 1e150;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// Blank-separated words with their places.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    /// Goes to the next word, over line ends; comments on the way are handed to `comment`. False at the end.
    template <class F>
    bool find(F comment) {
        while (position_ < text_.size()) {
            const char c = text_[position_];
            if (c == '\n') {
                ++line_;
                line_start_ = ++position_;
            } else if (is_blank(c)) {
                ++position_;
            } else if (c == '#') {
                const std::size_t end = std::min(text_.find('\n', position_), text_.size());
                comment(text_.substr(position_ + 1, end - position_ - 1));
                position_ = end;
            } else {
                return true;
            }
        }
        return false;
    }

    /// Whether the line has another word.
    bool line_goes_on() {
        while (position_ < text_.size() && text_[position_] != '\n' && is_blank(text_[position_])) {
            ++position_;
        }
        return position_ < text_.size() && text_[position_] != '\n' && text_[position_] != '#';
    }

    std::string_view peek() const {
        std::size_t end = position_;
        while (end < text_.size() && !is_blank(text_[end])) {
            ++end;
        }
        return text_.substr(position_, end - position_);
    }
    void skip(std::size_t length) { position_ += length; }

    /// After line_goes_on(): whether the line ends in a comment.
    bool comment_follows() const { return position_ < text_.size() && text_[position_] == '#'; }

    Place place() const {
        return {static_cast<std::uint32_t>(line_), static_cast<std::uint32_t>(position_ - line_start_ + 1)};
    }

private:
    std::string_view text_;
    std::size_t position_ = 0, line_ = 1, line_start_ = 0;
};

class Parser {
public:
    explicit Parser(std::string_view text) : words_(text) {}

    File parse() {
        find();
        file_.heading = file_.items.size();
        while (find()) {
            const Place place = words_.place();
            const std::string_view word = words_.peek();
            words_.skip(word.size());
            if (word == "v") {
                view(place);
                continue;
            }
            entity(word, place);
            if (words_.line_goes_on()) {
                fail(words_.place(), "`{}` is more than {} takes", shown(words_.peek()), entity_);
            }
            ends_a_line_ = words_.comment_follows();
        }
        if (!has_view_) {
            fail(words_.place(), "the file ends without a view (`v`)");
        }
        return std::move(file_);
    }

private:
    template <class... Args>
    [[noreturn]] static void fail(Place place, fmt::format_string<Args...> text, Args&&... args) {
        throw Error(place, fmt::format(text, std::forward<Args>(args)...));
    }
    static std::string shown(std::string_view word) {
        return lang::shortened(lang::printable(word.substr(0, 80)));
    }

    bool find() {
        return words_.find([&](std::string_view text) {
            file_.items.push_back(Comment{text, std::exchange(ends_a_line_, false)});
        });
    }

    void entity(std::string_view word, Place place) {
        if (word == "b") {
            entity_ = "a background (`b`)";
            if (file_.background) {
                fail(place, "there is a background already");
            }
            file_.background = color();
        } else if (word == "l") {
            entity_ = "a light (`l`)";
            light();
        } else if (word == "f") {
            entity_ = "a fill (`f`)";
            fill(place);
        } else if (word == "s") {
            entity_ = "a sphere (`s`)";
            shape(place);
            sphere();
        } else if (word == "c") {
            entity_ = "a cone (`c`)";
            shape(place);
            cone(place);
        } else if (word == "p" || word == "pp") {
            entity_ = word == "p" ? "a polygon (`p`)" : "a patch (`pp`)";
            shape(place);
            polygon(place, word == "pp");
        } else {
            fail(place, "there is no entity `{}`; an NFF file has v, b, l, f, s, c, p, pp and #",
                 shown(word));
        }
    }

    void shape(Place place) const {
        if (!has_fill_) {
            fail(place, "{} before the first fill (`f`) has no material", entity_);
        }
    }

    /// To the next word, which the entity needs.
    std::string_view needed(const char* what) {
        if (!find()) {
            fail(words_.place(), "the file ends in the middle of {}; {} is missing", entity_, what);
        }
        return words_.peek();
    }

    double number(const char* what) {
        const std::string_view word = needed(what);
        const char *begin = word.data(), *end = begin + word.size();
        double value = 0;
        const auto [rest, error] = std::from_chars(begin + (word.size() > 1 && *begin == '+'), end, value);
        if (rest != end || error == std::errc::invalid_argument) {
            fail(words_.place(), "`{}` is not a number; {} needs {} here", shown(word), entity_, what);
        }
        if (error != std::errc() || !(std::abs(value) <= largest_number)) {
            fail(words_.place(), "`{}` is no number that can be calculated with; {} needs {} here",
                 shown(word), entity_, what);
        }
        words_.skip(word.size());
        return value;
    }
    double not_negative(const char* what) {
        find();
        const Place place = words_.place();
        const double value = number(what);
        if (value < 0) {
            fail(place, "{} is {}; it is at least 0", what, value);
        }
        return value;
    }
    std::int64_t whole(const char* what, std::int64_t low, std::int64_t high) {
        const std::string_view word = needed(what);
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() || value < low || value > high) {
            fail(words_.place(), "{} is `{}`; it is a whole number from {} to {}", what, shown(word), low,
                 high);
        }
        words_.skip(word.size());
        return value;
    }
    Vec3 vector(const char* what) {
        const double x = number(what), y = number(what);
        return {x, y, number(what)};
    }
    Rgb color() {
        const double r = not_negative("red"), g = not_negative("green");
        return {r, g, not_negative("blue")};
    }
    /// NFF's negative radii, for shapes that are seen from inside alone, are in no known file.
    double radius() {
        find();
        const Place place = words_.place();
        const double value = number("a radius");
        if (value < 0) {
            fail(place,
                 "the radius is {}; NFF means a surface that is seen from inside alone, which has no "
                 "counterpart",
                 value);
        }
        return value;
    }

    void view(Place place) {
        if (has_view_) {
            fail(place, "there is a view already");
        }
        has_view_ = true;
        entity_ = "a view (`v`)";
        View& view = file_.view;
        view.place = place;
        static constexpr std::string_view names[] = {"from", "at", "up", "angle", "hither", "resolution"};
        bool given[std::size(names)] = {};
        if (words_.line_goes_on()) {
            fail(words_.place(), "`{}` is more than `v` takes", shown(words_.peek()));
        }
        Place up_place = place;
        while (find()) {
            const Place line = words_.place();
            const std::string_view word = words_.peek();
            const auto name = std::find(std::begin(names), std::end(names), word);
            if (name == std::end(names)) {
                break;
            }
            if (std::exchange(given[name - names], true)) {
                fail(line, "the view has `{}` twice", word);
            }
            words_.skip(word.size());
            switch (name - names) {
            case 0:
                view.from = vector("a coordinate");
                break;
            case 1:
                view.at = vector("a coordinate");
                break;
            case 2:
                view.up = vector("a coordinate");
                up_place = line;
                break;
            case 3:
                view.angle = number("an angle");
                if (!(view.angle > 0 && view.angle < 180)) {
                    fail(line, "the angle of view is {}; it lies between 0 and 180", view.angle);
                }
                break;
            case 4:
                view.hither = not_negative("hither");
                view.hither_place = line;
                break;
            default:
                view.width = static_cast<int>(whole("the picture's width", 1, largest_size));
                view.height = static_cast<int>(whole("the picture's height", 1, largest_size));
            }
            if (words_.line_goes_on()) {
                fail(words_.place(), "`{}` is more than `{}` takes", shown(words_.peek()), word);
            }
        }
        for (std::size_t i = 0; i < std::size(names); ++i) {
            if (!given[i] && names[i] != "hither") {
                fail(place, "the view has no `{}`", names[i]);
            }
        }
        check_frame(view, up_place);
    }
    static void check_frame(const View& view, Place up_place) {
        const Vec3 back = view.from - view.at;
        if (!(dot(back, back) > 0)) {
            fail(view.place, "`from` and `at` are the same point; the view has no direction");
        }
        const Vec3 right = cross(normalize(view.up), normalize(back));
        if (!(dot(right, right) > 1e-24)) {
            fail(up_place, "`up` is 0 or parallel to the direction of view");
        }
    }

    void light() {
        Light light{vector("a coordinate"), {}};
        if (words_.line_goes_on()) {
            light.color = color();
        }
        file_.lights.push_back(light);
    }

    void fill(Place place) {
        Fill fill;
        fill.place = place;
        fill.color = color();
        fill.kd = not_negative("Kd");
        fill.ks = not_negative("Ks");
        fill.shine = not_negative("Shine");
        fill.t = not_negative("T");
        fill.ior = number("an index of refraction");
        file_.items.push_back(fill);
        has_fill_ = true;
    }

    void sphere() {
        const Vec3 center = vector("a coordinate");
        find();
        const Place place = words_.place();
        const double r = radius();
        if (r == 0) {
            fail(place, "the radius is 0; that of a sphere is greater");
        }
        file_.items.push_back(Sphere{center, r});
    }

    void cone(Place place) {
        Cone cone;
        cone.base = vector("a coordinate");
        cone.base_radius = radius();
        cone.apex = vector("a coordinate");
        cone.apex_radius = radius();
        const runtime::Cone<double> shape{cone.base, cone.apex, cone.base_radius, cone.apex_radius, false};
        if (const std::string_view wrong = problem(shape); !wrong.empty()) {
            fail(place, "in this cone, base (`from`) to apex (`to`): {}", wrong);
        }
        file_.items.push_back(cone);
    }

    void polygon(Place place, bool is_patch) {
        Polygon polygon{place, file_.points.size(), 0, is_patch};
        polygon.count = static_cast<std::uint32_t>(whole("the number of corners", 3, most_corners));
        for (std::uint32_t i = 0; i < polygon.count; ++i) {
            file_.points.push_back(vector("a corner's coordinate"));
            if (is_patch) {
                file_.points.push_back(vector("a normal's component"));
            }
        }
        file_.items.push_back(polygon);
    }

    Words words_;
    const char* entity_ = "";
    bool has_view_ = false, has_fill_ = false, ends_a_line_ = false;
    File file_;
};

} // namespace

File parse(std::string_view text) {
    return Parser(text).parse();
}

} // namespace scc::compiler::nff
