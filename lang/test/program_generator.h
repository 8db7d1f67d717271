#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

namespace scc::lang::test {

/// Random texts that follow the grammar, with comments, blanks and line ends wherever they may stand. They
/// need not mean anything.
class ProgramGenerator {
public:
    explicit ProgramGenerator(std::uint32_t seed) : random_(seed) {}

    std::string file() {
        out_.clear();
        maybe_comment();
        if (chance(20)) {
            out_ += "language 1\n";
        }
        items(false, 3);
        return out_;
    }

private:
    bool chance(int percent) { return below(100) < percent; }
    int below(int count) { return static_cast<int>(random_() % static_cast<std::uint32_t>(count)); }
    template <std::size_t N>
    const char* one_of(const char* const (&words)[N]) {
        return words[below(static_cast<int>(N))];
    }

    void blank() { out_ += one_of({" ", " ", " ", "  ", "\t"}); }
    void maybe_blank() {
        if (chance(30)) {
            blank();
        }
        if (chance(3)) {
            out_ += one_of({"/* c */", " /**/ ", "/* // */"});
        }
    }
    void maybe_comment() {
        while (chance(15)) {
            out_ += one_of({"// note\n", "  // \xC3\xA9 note  \n", "/* block */\n", "/* two\n   lines */\n",
                            "\n\n\n", "\n"});
        }
    }
    void line_end() {
        if (chance(15)) {
            out_ += one_of({" // end", "  /* end */", "// x  ", " /* a */ // b"});
        }
        out_ += chance(15) ? "\r\n" : "\n";
    }
    /// Where line ends are blanks: in brackets, and behind what leaves a line open.
    void free_blank() {
        if (chance(8)) {
            line_end();
            maybe_comment();
        }
        maybe_blank();
    }
    void space_or_line() {
        blank();
        if (chance(6)) {
            line_end();
        }
    }

    void name() { out_ += one_of({"a", "b", "size", "a_long_name", "Red", "x1", "s", "palette_of_colours"}); }
    void number() {
        out_ += one_of({"0", "1", "2.5", "1e-3", "0.30", "100", "6.02e23"});
        if (chance(15)) {
            out_ += one_of({"deg", "rad", "mm", "inch"});
        }
    }
    void string() {
        out_ +=
            one_of({"\"\"", "\"text\"", "\"a \\\"b\\\" // c\"", "\"{ /* \\\\ */ }\"", "\"\xE2\x82\xAC\""});
    }

    void type(int depth) {
        const int kind = depth > 0 ? below(6) : 0;
        if (kind == 4) {
            out_ += "[";
            type(depth - 1);
            out_ += "]";
        } else if (kind == 5) {
            out_ += "fn(";
            type(depth - 1);
            if (chance(40)) {
                out_ += " ,";
                type(depth - 1);
            }
            out_ += ") ->";
            maybe_blank();
            type(depth - 1);
        } else {
            out_ += one_of({"number", "vec3", "color", "shape"});
        }
    }
    void formals() {
        out_ += "(";
        const int count = below(3);
        for (int i = 0; i < count; ++i) {
            out_ += i > 0 ? "," : "";
            free_blank();
            name();
            maybe_blank();
            out_ += ":";
            maybe_blank();
            type(2);
            if (chance(20)) {
                out_ += " = ";
                primary(1);
            }
        }
        out_ += ")";
    }

    void expression(int depth) {
        if (depth > 0 && chance(6)) {
            out_ += "if (";
            expression(depth - 1);
            out_ += ")";
            space_or_blank();
            expression(depth - 1);
            space_or_line();
            out_ += "else";
            space_or_line();
            return expression(depth - 1);
        }
        operand(depth);
        while (depth > 0 && chance(35)) {
            const char* op = one_of({"+", "-", "*", "/", "%", "then", "and", "or", "^"});
            const bool is_word = op[0] >= 'a' && op[0] <= 'z';
            if (is_word) {
                space_or_line();
            } else {
                maybe_blank();
            }
            out_ += op;
            if (is_word || chance(60)) {
                space_or_line();
            }
            operand(depth - 1);
        }
    }
    void space_or_blank() { blank(); }
    void comparison(int depth) {
        operand(depth);
        maybe_blank();
        out_ += one_of({"==", "!=", "<", "<=", ">", ">=", ".."});
        maybe_blank();
        operand(depth);
    }
    void operand(int depth) {
        if (chance(10)) {
            out_ += one_of({"-", "- ", "not ", "--"});
        }
        primary(depth);
        while (depth > 0 && chance(20)) {
            switch (below(3)) {
            case 0:
                out_ += ".";
                name();
                break;
            case 1:
                arguments(depth - 1);
                break;
            default:
                out_ += "[";
                free_blank();
                expression(depth - 1);
                free_blank();
                out_ += "]";
            }
        }
    }
    void arguments(int depth) {
        maybe_blank();
        out_ += "(";
        const int count = below(4);
        for (int i = 0; i < count; ++i) {
            out_ += i > 0 ? "," : "";
            free_blank();
            if (chance(15)) {
                name();
                out_ += "=";
            }
            expression(depth);
            free_blank();
        }
        out_ += ")";
    }
    void elements(int depth, int count) {
        for (int i = 0; i < count; ++i) {
            out_ += i > 0 ? "," : "";
            free_blank();
            expression(depth);
            free_blank();
        }
    }
    void primary(int depth) {
        switch (depth > 0 ? below(13) : below(5)) {
        case 0:
        case 1:
            return name();
        case 2:
            return number();
        case 3:
            return string();
        case 4:
            out_ += one_of({"true", "false", "#c83232"});
            return;
        case 5:
        case 6:
            out_ += "(";
            elements(depth - 1, 1 + below(3));
            out_ += ")";
            return;
        case 7:
            out_ += "[";
            elements(depth - 1, below(9));
            out_ += "]";
            return;
        case 8:
            out_ += "[for (";
            name();
            out_ += " in ";
            comparison(depth - 1);
            out_ += ")";
            free_blank();
            blank();
            expression(depth - 1);
            out_ += "]";
            return;
        case 9:
            out_ += "(fn";
            formals();
            out_ += "=";
            maybe_blank();
            expression(depth - 1);
            out_ += ")";
            return;
        case 10:
            out_ += "(";
            comparison(depth - 1);
            out_ += ")";
            return;
        default:
            name();
            maybe_blank();
            return body(true, depth - 1);
        }
    }

    void body(bool is_thing, int depth) {
        out_ += "{";
        is_one_line_ = is_one_line_ || chance(50);
        const bool outer = is_one_line_;
        maybe_blank();
        if (!is_one_line_) {
            line_end();
            maybe_comment();
        }
        items(is_thing, depth);
        is_one_line_ = outer;
        out_ += "}";
        is_one_line_ = false;
    }
    void separator() {
        maybe_blank();
        if (is_one_line_) {
            out_ += one_of({",", ", ", ";"});
        } else {
            out_ += one_of({"", "", "", ",", ";", " ,"});
            line_end();
            maybe_comment();
        }
    }
    void items(bool is_thing, int depth) {
        const bool is_one_line = is_one_line_;
        const int count = below(depth > 2 ? 6 : 4);
        for (int i = 0; i < count; ++i) {
            is_one_line_ = is_one_line;
            item(is_thing, depth);
            is_one_line_ = is_one_line;
            if (i + 1 < count || chance(50)) {
                separator();
            }
        }
        if (!is_one_line && count > 0) {
            line_end();
        }
        is_one_line_ = is_one_line;
    }
    void item(bool is_thing, int depth) {
        const int deeper = depth > 0 ? depth - 1 : 0;
        switch (is_thing && chance(60) ? 6 : below(is_thing ? 6 : 8)) {
        case 0:
            out_ += "let ";
            name();
            if (chance(20)) {
                out_ += " : ";
                type(1);
            }
            out_ += one_of({" = ", "=", " =\n  "});
            return expression(deeper + 1);
        case 1:
            out_ += "fn ";
            name();
            formals();
            if (chance(40)) {
                out_ += " -> ";
                type(1);
            }
            maybe_blank();
            if (chance(50)) {
                out_ += one_of({"= ", "=", "=\n"});
                return expression(deeper + 1);
            }
            out_ += "{ let k = ";
            expression(deeper);
            out_ += chance(50) ? "\n" : ", ";
            expression(deeper);
            out_ += chance(50) ? "\n}" : " }";
            return;
        case 2:
            out_ += "for (";
            name();
            out_ += " in ";
            comparison(deeper);
            out_ += ")";
            maybe_blank();
            return body(is_thing, deeper);
        case 3:
            out_ += "if (";
            expression(deeper);
            out_ += ")";
            maybe_blank();
            body(is_thing, deeper);
            while (chance(40)) {
                space_or_line();
                out_ += "else if (";
                name();
                out_ += ") ";
                body(is_thing, deeper);
            }
            if (chance(40)) {
                space_or_line();
                out_ += "else ";
                body(is_thing, deeper);
            }
            return;
        case 4:
        case 5:
            name();
            maybe_blank();
            return body(true, deeper);
        case 6:
            if (is_thing) {
                name();
                out_ += one_of({" = ", "=", "  ="});
                return expression(deeper + 1);
            }
            out_ += "param ";
            name();
            out_ += ": number = ";
            number();
            if (chance(50)) {
                out_ += " in 0 .. 1";
            }
            if (chance(50)) {
                out_ += " \"text\"";
            }
            return;
        default:
            out_ += "import \"a.scn\" as ";
            name();
            if (chance(50)) {
                out_ += " with ";
                body(true, deeper);
            }
        }
    }

    std::mt19937 random_;
    std::string out_;
    bool is_one_line_ = false; ///< the body that is being written
};

} // namespace scc::lang::test
