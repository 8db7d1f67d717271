#include "lang/diagnostic.h"
#include "lang/utf8.h"

#include <algorithm>

namespace scc::lang {
namespace {

constexpr std::size_t tab_width = 4;
constexpr std::size_t longest_line = 120; ///< in bytes; of a longer line the part around the range is shown
constexpr std::size_t shown_before = 40;
constexpr std::size_t shown_length = 100;
constexpr std::string_view cut_mark = "...";

struct Style {
    std::string_view severity, bold, mark, fix, reset;
};

Style style_of(Severity severity, bool color) {
    if (!color) {
        return {};
    }
    const std::string_view severity_color = severity == Severity::error     ? "\x1b[1;31m"
                                            : severity == Severity::warning ? "\x1b[1;35m"
                                                                            : "\x1b[1;36m";
    return {severity_color, "\x1b[1m", "\x1b[1;32m", "\x1b[32m", "\x1b[0m"};
}

std::string_view word(Severity severity) {
    switch (severity) {
    case Severity::note:
        return "note";
    case Severity::warning:
        return "warning";
    case Severity::error:
        return "error";
    }
    return {};
}

std::string place(const SourceSet& sources, Span span) {
    if (!sources.contains(span.file)) {
        return {};
    }
    const SourceFile& file = sources.file(span.file);
    const Position position = file.position(span.begin);
    return fmt::format("{}:{}:{}: ", printable(file.path()), position.line, position.column);
}

std::string headline(const SourceSet& sources, Span span, Severity severity, std::string_view text,
                     bool color) {
    const Style style = style_of(severity, color);
    return fmt::format("{}{}{}{}: {}{}{}{}", style.bold, place(sources, span), style.severity, word(severity),
                       style.reset, style.bold, printable(text), style.reset);
}

/// Text with tabs expanded and what a terminal cannot show replaced, and its width in columns.
struct Shown {
    std::string text;
    std::size_t width = 0;
};

Shown show(std::string_view bytes) {
    Shown shown;
    for (std::size_t i = 0; i < bytes.size();) {
        const Character c = decode(bytes, i);
        if (c.code == '\t') {
            const std::size_t blanks = tab_width - shown.width % tab_width;
            shown.text.append(blanks, ' ');
            shown.width += blanks;
        } else {
            const std::string text = printable(bytes.substr(i, c.length));
            const bool replaced = text != bytes.substr(i, c.length);
            shown.text += text;
            shown.width += replaced ? 1 : static_cast<std::size_t>(display_width(c.code));
        }
        i += c.length;
    }
    return shown;
}

/// The part of a source line that is shown, and where on it a byte of the line stands.
class Excerpt {
public:
    Excerpt(std::string_view line, std::size_t begin) : line_(line), to_(line.size()) {
        if (line.size() > longest_line) {
            from_ = begin > shown_before ? character_start(begin - shown_before) : 0;
            to_ = character_start(std::min(line.size(), from_ + shown_length));
        }
    }

    bool shows(std::size_t byte) const { return byte >= from_ && byte <= to_; }
    std::size_t column(std::size_t byte) const {
        const std::size_t end = std::clamp(byte, from_, to_);
        return left_mark().size() + show(line_.substr(from_, end - from_)).width;
    }
    std::string text() const {
        std::string text(left_mark());
        text += show(line_.substr(from_, to_ - from_)).text;
        text += to_ < line_.size() ? cut_mark : "";
        return text;
    }

private:
    std::string_view left_mark() const { return from_ > 0 ? cut_mark : ""; }
    std::size_t character_start(std::size_t byte) const {
        constexpr std::size_t longest_tail = 3;
        for (std::size_t i = 0; i < longest_tail && byte > 0 && byte < line_.size(); ++i, --byte) {
            if ((static_cast<unsigned char>(line_[byte]) & 0xc0) != 0x80) {
                break;
            }
        }
        return byte;
    }

    std::string_view line_;
    std::size_t from_ = 0;
    std::size_t to_;
};

class Renderer {
public:
    Renderer(const SourceFile& file, const Diagnostic& diagnostic, bool color)
        : diagnostic_(diagnostic), position_(file.position(diagnostic.span.begin)),
          line_(file.line(position_.line)), excerpt_(line_, position_.column - 1),
          style_(style_of(diagnostic.severity, color)) {}

    std::string run() const {
        std::string out = fmt::format("{:>5} | {}\n", position_.line, excerpt_.text());
        const std::size_t digits = std::max<std::size_t>(5, fmt::formatted_size("{}", position_.line));
        const std::string gutter = fmt::format("{:>{}} | ", "", digits);
        out += fmt::format("{}{}{}{}\n", gutter, style_.mark, mark(), style_.reset);
        const std::string fix = replacement();
        if (!fix.empty()) {
            out += fmt::format("{}{}{}{}\n", gutter, style_.fix, fix, style_.reset);
        }
        return out;
    }

private:
    std::size_t line_begin() const { return diagnostic_.span.begin - (position_.column - 1); }

    std::string mark() const {
        const std::size_t begin = excerpt_.column(position_.column - 1);
        const std::size_t last_byte = std::max(diagnostic_.span.end, diagnostic_.span.begin) - line_begin();
        const std::size_t end = excerpt_.column(std::min(last_byte, line_.size()));
        const std::size_t width = end > begin ? end - begin : 1;
        return std::string(begin, ' ') + '^' + std::string(width - 1, '~');
    }

    /// Empty where the fix removes text or lies on another line.
    std::string replacement() const {
        if (!diagnostic_.fix || diagnostic_.fix->replacement.find('\n') != std::string::npos) {
            return {};
        }
        const Span span = diagnostic_.fix->span;
        const std::size_t begin = line_begin();
        if (span.file != diagnostic_.span.file || span.begin < begin || span.end < span.begin ||
            span.end > begin + line_.size() || !excerpt_.shows(span.begin - begin)) {
            return {};
        }
        std::string text = show(diagnostic_.fix->replacement).text;
        text.erase(text.find_last_not_of(' ') + 1);
        return text.empty() ? text : std::string(excerpt_.column(span.begin - begin), ' ') + text;
    }

    const Diagnostic& diagnostic_;
    Position position_;
    std::string_view line_;
    Excerpt excerpt_;
    Style style_;
};

} // namespace

std::string render_text(const SourceSet& sources, const Diagnostic& diagnostic, bool color) {
    const std::string text = fmt::format("{} [{}]", diagnostic.message, row(diagnostic.kind).name);
    std::string out = headline(sources, diagnostic.span, diagnostic.severity, text, color) + '\n';
    if (sources.contains(diagnostic.span.file)) {
        out += Renderer(sources.file(diagnostic.span.file), diagnostic, color).run();
    }
    for (const Note& note : diagnostic.notes) {
        out += headline(sources, note.span, Severity::note, note.text, color) + '\n';
    }
    return out;
}

} // namespace scc::lang
