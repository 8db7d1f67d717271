#include "runtime/host/deflate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

static_assert(std::endian::native == std::endian::little, "words are read as the first byte lowest");

namespace scc::host {

namespace {

constexpr std::size_t window = 32768;
constexpr std::size_t longest_match = 258;
constexpr int end_of_block = 256, first_length = 257;
constexpr std::size_t literal_symbols = 286, distance_symbols = 30, length_symbols = 19;
constexpr int longest_code = 15, longest_length_code = 7;

// ---- codes of match lengths and distances (RFC 1951, 3.2.5) ---------------------------------------------

struct Range {
    std::uint16_t base;
    std::uint8_t extra_bits;
};

/// Ranges that grow by one bit every `per_size` codes; the first 2 * per_size hold one value each.
template <std::size_t n>
constexpr std::array<Range, n> growing_ranges(unsigned first, unsigned per_size) {
    std::array<Range, n> ranges{};
    unsigned base = first;
    for (unsigned i = 0; i < n; ++i) {
        const unsigned extra = i < 2 * per_size ? 0 : i / per_size - 1;
        ranges[i] = {static_cast<std::uint16_t>(base), static_cast<std::uint8_t>(extra)};
        base += 1U << extra;
    }
    return ranges;
}

constexpr auto lengths = [] {
    auto ranges = growing_ranges<29>(3, 4);
    ranges[28] = {longest_match, 0}; // has a code of its own
    return ranges;
}();
constexpr auto distances = growing_ranges<distance_symbols>(1, 2);

constexpr auto code_of_length = [] {
    std::array<std::uint8_t, longest_match + 1> codes{};
    for (std::size_t code = 0; code < lengths.size(); ++code) {
        for (std::size_t length = lengths[code].base; length <= longest_match; ++length) {
            codes[length] = static_cast<std::uint8_t>(code);
        }
    }
    return codes;
}();

unsigned code_of_distance(unsigned distance) {
    const unsigned d = distance - 1;
    if (d < 4) {
        return d;
    }
    const auto high = static_cast<unsigned>(std::bit_width(d)) - 1;
    return 2 * high + (d >> (high - 1) & 1U);
}

// ---- tokens -----------------------------------------------------------------------------------------------

/// A byte, or a stretch that stood `distance` bytes before.
struct Token {
    std::uint16_t length; ///< 0: a byte
    std::uint16_t value;  ///< the byte, or distance - 1
};

std::uint32_t load4(const char* at) {
    std::uint32_t word = 0;
    std::memcpy(&word, at, sizeof word);
    return word;
}

std::size_t common_length(const char* a, const char* b, std::size_t most) {
    std::size_t length = 0;
    while (length + 8 <= most) {
        std::uint64_t x = 0, y = 0;
        std::memcpy(&x, a + length, sizeof x);
        std::memcpy(&y, b + length, sizeof y);
        if (x != y) {
            return length + static_cast<std::size_t>(std::countr_zero(x ^ y)) / 8;
        }
        length += 8;
    }
    while (length < most && a[length] == b[length]) {
        ++length;
    }
    return length;
}

std::uint64_t load8(const char* at) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, sizeof word);
    return word;
}

/// What each byte will cost on its own, roughly, in eighths of a bit.
std::array<unsigned, 256> guess_costs(std::string_view bytes) {
    constexpr std::size_t stride = 7; // a few samples tell; no multiple of a pixel's size
    std::array<unsigned, 256> counts{};
    unsigned total = 1;
    for (std::size_t i = 1; i + 8 <= bytes.size(); i += stride) {
        // Not where all bytes are the same: such stretches are taken as a whole.
        if (load8(&bytes[i]) != load8(&bytes[i - 1])) {
            ++counts[static_cast<unsigned char>(bytes[i])];
            ++total;
        }
    }
    std::array<unsigned, 256> costs{};
    for (std::size_t byte = 0; byte < costs.size(); ++byte) {
        costs[byte] =
            std::max(8U, static_cast<unsigned>(8 * std::log2(3 * static_cast<float>(total) /
                                                             (3.0F * static_cast<float>(counts[byte]) + 1))));
    }
    return costs;
}

/// Repetitions are taken where they are cheaper than their bytes. In rendered pictures, filtered, most bytes
/// are small differences that cost a bit or two: a short repetition from far away costs more.
std::vector<Token> find_tokens(std::string_view bytes) {
    constexpr int hash_bits = 13;
    constexpr std::uint32_t hashed = 6;          // bytes, and so the shortest repetition
    constexpr unsigned repetition_cost = 14 * 8; // without the bits of its distance
    constexpr std::size_t always_cheaper = 32;
    const std::array<unsigned, 256> costs = guess_costs(bytes);
    std::array<std::uint32_t, std::size_t{1} << hash_bits> last_seen;
    last_seen.fill(std::uint32_t{1} << 31); // far off
    std::vector<Token> tokens;
    tokens.reserve(bytes.size() / 2);
    const char* const data = bytes.data();
    const auto end = static_cast<std::uint32_t>(bytes.size());
    std::uint32_t at = 0;
    while (at + 8 <= end) {
        const std::uint64_t here = load8(data + at);
        std::uint32_t& seen = last_seen[(here << 16) * 0x9e3779b97f4a7c15 >> (64 - hash_bits)];
        const std::uint32_t before = seen, distance = at - before;
        seen = at;
        std::uint32_t bytes_alone = 1;
        if (distance <= window && (load8(data + before) ^ here) << 16 == 0) {
            const std::size_t length =
                common_length(data + at, data + before, std::min<std::size_t>(end - at, longest_match));
            unsigned saved = 0;
            for (std::size_t i = 0; i < std::min(length, always_cheaper); ++i) {
                saved += costs[static_cast<unsigned char>(data[at + i])];
            }
            if (length >= always_cheaper ||
                saved >= repetition_cost + 8 * static_cast<unsigned>(std::bit_width(distance))) {
                tokens.push_back(
                    {static_cast<std::uint16_t>(length), static_cast<std::uint16_t>(distance - 1)});
                at += static_cast<std::uint32_t>(length);
                continue;
            }
            // Nor will it be cheaper to begin it later.
            bytes_alone = static_cast<std::uint32_t>(length) - hashed + 1;
        }
        for (const std::uint32_t stop = at + bytes_alone; at < stop; ++at) {
            tokens.push_back({0, static_cast<unsigned char>(data[at])});
        }
    }
    for (; at < end; ++at) {
        tokens.push_back({0, static_cast<unsigned char>(data[at])});
    }
    return tokens;
}

// ---- Huffman codes ----------------------------------------------------------------------------------------

struct Code {
    std::uint16_t bits = 0; ///< in the order in which they are written, first lowest
    std::uint8_t length = 0;
};

/// How many codes there are of each length in a Huffman code for these counts, rising; none longer than
/// `longest`.
std::vector<std::uint32_t> count_lengths(const std::vector<std::uint64_t>& rising, int longest) {
    // Two queues, of leaves and of the joints made of them, both rising.
    const std::size_t n = rising.size();
    std::vector<std::uint64_t> weight(rising);
    std::vector<std::size_t> parent(2 * n, 0);
    std::size_t leaf = 0, joint = n;
    const auto take = [&] {
        const bool from_leaves = joint >= weight.size() || (leaf < n && weight[leaf] <= weight[joint]);
        return from_leaves ? leaf++ : joint++;
    };
    while (weight.size() < 2 * n - 1) {
        const std::size_t a = take(), b = take();
        parent[a] = parent[b] = weight.size();
        weight.push_back(weight[a] + weight[b]);
    }
    std::vector<std::uint32_t> depth(weight.size(), 0), counts(static_cast<std::size_t>(longest) + 1, 0);
    for (std::size_t i = weight.size() - 1; i-- > 0;) {
        depth[i] = depth[parent[i]] + 1;
        if (i < n) {
            ++counts[std::min(depth[i], static_cast<std::uint32_t>(longest))];
        }
    }
    // Where codes were cut short there are too many: lengthen others until all fit (Kraft's sum is 1).
    std::uint64_t total = 0;
    for (int length = 1; length <= longest; ++length) {
        total += std::uint64_t{counts[static_cast<std::size_t>(length)]} << (longest - length);
    }
    for (; total > std::uint64_t{1} << longest; --total) {
        auto length = static_cast<std::size_t>(longest) - 1;
        while (counts[length] == 0) {
            --length;
        }
        --counts[length];
        counts[length + 1] += 2;
        --counts[static_cast<std::size_t>(longest)];
    }
    return counts;
}

/// At least two codes, as some decoders want.
template <std::size_t n>
std::array<Code, n> huffman_codes(std::array<std::uint32_t, n> counts, int longest) {
    for (std::size_t i = 0; std::count(counts.begin(), counts.end(), 0U) > static_cast<std::ptrdiff_t>(n) - 2;
         ++i) {
        counts[i] = std::max(counts[i], 1U);
    }
    std::vector<std::uint16_t> symbols;
    for (std::uint16_t i = 0; i < n; ++i) {
        if (counts[i] != 0) {
            symbols.push_back(i);
        }
    }
    std::stable_sort(symbols.begin(), symbols.end(), [&](auto a, auto b) { return counts[a] < counts[b]; });
    std::vector<std::uint64_t> rising;
    for (const std::uint16_t symbol : symbols) {
        rising.push_back(counts[symbol]);
    }
    const std::vector<std::uint32_t> of_length = count_lengths(rising, longest);
    std::array<Code, n> codes{};
    std::size_t next = 0;
    for (int length = longest; length > 0; --length) {
        for (std::uint32_t i = 0; i < of_length[static_cast<std::size_t>(length)]; ++i) {
            codes[symbols[next++]].length = static_cast<std::uint8_t>(length);
        }
    }
    // Canonical: by length, then by symbol.
    unsigned value = 0;
    for (int length = 1; length <= longest; ++length) {
        value <<= 1;
        for (Code& code : codes) {
            if (code.length == length) {
                unsigned reversed = 0;
                for (int bit = 0; bit < length; ++bit) {
                    reversed |= (value >> bit & 1U) << (length - 1 - bit);
                }
                code.bits = static_cast<std::uint16_t>(reversed);
                ++value;
            }
        }
    }
    return codes;
}

// ---- writing ----------------------------------------------------------------------------------------------

class BitWriter {
public:
    /// Room for `bytes` more, which nothing below checks.
    void reserve(std::size_t bytes) { text_.resize(size_ + bytes + sizeof buffer_); }
    /// At most 56 bits between two flushes.
    void add(std::uint64_t bits, int count) {
        buffer_ |= bits << filled_;
        filled_ += count;
    }
    void flush() {
        std::memcpy(&text_[size_], &buffer_, sizeof buffer_);
        const int whole = filled_ & ~7;
        size_ += static_cast<std::size_t>(whole / 8);
        buffer_ >>= whole; // at most 56
        filled_ -= whole;
    }
    void put(std::uint64_t bits, int count) {
        add(bits, count);
        flush();
    }
    void put(Code code) { put(code.bits, code.length); }
    void fill_byte() {
        filled_ = (filled_ + 7) & ~7;
        flush();
    }
    void append(std::string_view bytes) {
        std::copy(bytes.begin(), bytes.end(), text_.begin() + static_cast<std::ptrdiff_t>(size_));
        size_ += bytes.size();
    }
    std::string take() {
        text_.resize(size_);
        return std::move(text_);
    }

private:
    std::string text_;
    std::size_t size_ = 0;
    std::uint64_t buffer_ = 0;
    int filled_ = 0; ///< bits of the buffer; fewer than 8 after a flush
};

/// The code lengths of both alphabets, runs written short (RFC 1951, 3.2.7).
struct PackedLengths {
    struct Item {
        std::uint8_t symbol, extra, extra_bits;
    };
    std::vector<Item> items;
    std::size_t literals = literal_symbols, distances = distance_symbols;

    PackedLengths(const std::array<Code, literal_symbols>& literal,
                  const std::array<Code, distance_symbols>& distance) {
        while (literals > 257 && literal[literals - 1].length == 0) {
            --literals;
        }
        while (distances > 1 && distance[distances - 1].length == 0) {
            --distances;
        }
        std::vector<std::uint8_t> all;
        for (std::size_t i = 0; i < literals; ++i) {
            all.push_back(literal[i].length);
        }
        for (std::size_t i = 0; i < distances; ++i) {
            all.push_back(distance[i].length);
        }
        for (std::size_t i = 0; i < all.size();) {
            std::size_t run = 1;
            while (i + run < all.size() && all[i + run] == all[i]) {
                ++run;
            }
            i += add_run(all[i], run);
        }
    }

private:
    /// How many of the run are done.
    std::size_t add_run(std::uint8_t length, std::size_t run) {
        const auto add = [&](int symbol, std::size_t least, int bits, std::size_t most) {
            const std::size_t done = std::min(run, most);
            items.push_back({static_cast<std::uint8_t>(symbol), static_cast<std::uint8_t>(done - least),
                             static_cast<std::uint8_t>(bits)});
            return done;
        };
        if (length == 0 && run >= 11) {
            return add(18, 11, 7, 138);
        }
        if (length == 0 && run >= 3) {
            return add(17, 3, 3, 10);
        }
        items.push_back({length, 0, 0});
        if (length != 0 && run >= 4) {
            --run;
            return 1 + add(16, 3, 2, 6);
        }
        return 1;
    }
};

void write_stored(BitWriter& out, std::string_view bytes, bool last) {
    constexpr std::size_t most = 65535;
    do {
        const std::string_view part = bytes.substr(0, most);
        bytes.remove_prefix(part.size());
        out.put(last && bytes.empty() ? 1 : 0, 3);
        out.fill_byte();
        const auto size = static_cast<unsigned>(part.size());
        for (const unsigned half : {size, ~size}) {
            const char pair[] = {static_cast<char>(half & 0xff), static_cast<char>(half >> 8 & 0xff)};
            out.append({pair, sizeof pair});
        }
        out.append(part);
    } while (!bytes.empty());
}

std::uint64_t bits_of(const std::vector<Token>& tokens, const std::array<Code, literal_symbols>& literal,
                      const std::array<Code, distance_symbols>& distance,
                      const std::array<std::uint32_t, literal_symbols>& literal_counts,
                      const std::array<std::uint32_t, distance_symbols>& distance_counts) {
    std::uint64_t bits = tokens.size() / 8; // the head's, roughly
    for (std::size_t i = 0; i < literal_symbols; ++i) {
        const int extra = i >= first_length ? lengths[i - first_length].extra_bits : 0;
        bits += std::uint64_t{literal_counts[i]} * static_cast<unsigned>(literal[i].length + extra);
    }
    for (std::size_t i = 0; i < distance_symbols; ++i) {
        bits += std::uint64_t{distance_counts[i]} *
                static_cast<unsigned>(distance[i].length + distances[i].extra_bits);
    }
    return bits;
}

void write_head(BitWriter& out, const std::array<Code, literal_symbols>& literal,
                const std::array<Code, distance_symbols>& distance) {
    const PackedLengths packed(literal, distance);
    std::array<std::uint32_t, length_symbols> counts{};
    for (const PackedLengths::Item& item : packed.items) {
        ++counts[item.symbol];
    }
    const auto codes = huffman_codes(counts, longest_length_code);
    constexpr std::array<std::uint8_t, length_symbols> order{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                             11, 4,  12, 3, 13, 2, 14, 1, 15};
    std::size_t used = length_symbols;
    while (used > 4 && codes[order[used - 1]].length == 0) {
        --used;
    }
    out.put(packed.literals - 257, 5);
    out.put(packed.distances - 1, 5);
    out.put(used - 4, 4);
    for (std::size_t i = 0; i < used; ++i) {
        out.put(codes[order[i]].length, 3);
    }
    for (const PackedLengths::Item& item : packed.items) {
        out.put(codes[item.symbol]);
        out.put(item.extra, item.extra_bits);
    }
}

void write_tokens(BitWriter& out, const std::vector<Token>& tokens,
                  const std::array<Code, literal_symbols>& literal,
                  const std::array<Code, distance_symbols>& distance) {
    for (const Token& token : tokens) {
        if (token.length == 0) {
            out.put(literal[token.value]);
            continue;
        }
        // At most 15 + 5 + 15 + 13 bits.
        const std::size_t length_code = code_of_length[token.length];
        out.add(literal[first_length + length_code].bits, literal[first_length + length_code].length);
        out.add(static_cast<unsigned>(token.length) - lengths[length_code].base,
                lengths[length_code].extra_bits);
        const unsigned distance_code = code_of_distance(token.value + 1U);
        out.add(distance[distance_code].bits, distance[distance_code].length);
        out.add(token.value + 1U - distances[distance_code].base, distances[distance_code].extra_bits);
        out.flush();
    }
    out.put(literal[end_of_block]);
}

} // namespace

std::string deflate_part(std::string_view bytes, bool last) {
    const std::vector<Token> tokens = find_tokens(bytes);
    std::array<std::uint32_t, literal_symbols> literal_counts{};
    std::array<std::uint32_t, distance_symbols> distance_counts{};
    literal_counts[end_of_block] = 1;
    for (const Token& token : tokens) {
        if (token.length == 0) {
            ++literal_counts[token.value];
        } else {
            ++literal_counts[first_length + code_of_length[token.length]];
            ++distance_counts[code_of_distance(token.value + 1U)];
        }
    }
    const auto literal = huffman_codes(literal_counts, longest_code);
    const auto distance = huffman_codes(distance_counts, longest_code);
    const std::uint64_t size = bits_of(tokens, literal, distance, literal_counts, distance_counts) / 8;

    BitWriter out;
    constexpr std::size_t room_for_heads = 1024;
    if (size >= bytes.size()) {
        out.reserve(bytes.size() + bytes.size() / 1024 + room_for_heads);
        write_stored(out, bytes, last);
        return out.take();
    }
    out.reserve(size + room_for_heads);
    out.put(last ? 1 : 0, 1);
    out.put(2, 2); // codes of its own
    write_head(out, literal, distance);
    write_tokens(out, tokens, literal, distance);
    if (last) {
        out.fill_byte();
    } else {
        write_stored(out, {}, false); // ends on a whole byte
    }
    return out.take();
}

std::uint32_t adler32(std::string_view bytes) {
    constexpr std::uint32_t modulus = 65521;
    constexpr std::size_t without_overflow = 5552;
    std::uint32_t a = 1, b = 0;
    while (!bytes.empty()) {
        const std::string_view part = bytes.substr(0, without_overflow);
        bytes.remove_prefix(part.size());
        // Every 16th byte has sums of its own, so that vectors add them. What b gains by a byte is how many
        // bytes from it to the end: 16 for each later row, less its place in the row.
        constexpr std::uint32_t lanes = 16;
        std::array<std::uint32_t, lanes> sums{}, sums_of_sums{};
        std::size_t i = 0;
        for (; i + lanes <= part.size(); i += lanes) {
            for (std::uint32_t k = 0; k < lanes; ++k) {
                sums[k] += static_cast<unsigned char>(part[i + k]);
                sums_of_sums[k] += sums[k];
            }
        }
        b += static_cast<std::uint32_t>(i) * a;
        for (std::uint32_t k = 0; k < lanes; ++k) {
            b += lanes * sums_of_sums[k] - k * sums[k];
            a += sums[k];
        }
        for (; i < part.size(); ++i) {
            a += static_cast<unsigned char>(part[i]);
            b += a;
        }
        a %= modulus;
        b %= modulus;
    }
    return b << 16 | a;
}

std::uint32_t adler32_joined(std::uint32_t first, std::uint32_t second, std::uint64_t length) {
    constexpr std::uint64_t modulus = 65521;
    const std::uint64_t a1 = first & 0xffff, b1 = first >> 16, a2 = second & 0xffff, b2 = second >> 16;
    const std::uint64_t a = (a1 + a2 + modulus - 1) % modulus;
    const std::uint64_t b = (b1 + b2 + length % modulus * (a1 + modulus - 1)) % modulus;
    return static_cast<std::uint32_t>(b << 16 | a);
}

std::string zlib_compress(std::string_view bytes) {
    std::string result(zlib_head);
    result += deflate_part(bytes, true);
    append_big_endian(result, adler32(bytes));
    return result;
}

std::uint32_t crc32(std::string_view bytes) {
    // Entry [k][byte]: what the byte contributes when k more follow it, so that 8 are looked up at once.
    static constexpr auto tables = [] {
        std::array<std::array<std::uint32_t, 256>, 8> table{};
        for (std::uint32_t byte = 0; byte < 256; ++byte) {
            std::uint32_t value = byte;
            for (int bit = 0; bit < 8; ++bit) {
                value = value >> 1 ^ ((value & 1U) != 0 ? 0xedb88320U : 0U);
            }
            table[0][byte] = value;
        }
        for (std::size_t k = 1; k < table.size(); ++k) {
            for (std::size_t byte = 0; byte < 256; ++byte) {
                const std::uint32_t before = table[k - 1][byte];
                table[k][byte] = before >> 8 ^ table[0][before & 0xff];
            }
        }
        return table;
    }();
    std::uint32_t crc = ~0U;
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        const std::uint32_t low = load4(&bytes[i]) ^ crc, high = load4(&bytes[i + 4]);
        crc = tables[7][low & 0xff] ^ tables[6][low >> 8 & 0xff] ^ tables[5][low >> 16 & 0xff] ^
              tables[4][low >> 24] ^ tables[3][high & 0xff] ^ tables[2][high >> 8 & 0xff] ^
              tables[1][high >> 16 & 0xff] ^ tables[0][high >> 24];
    }
    for (; i < bytes.size(); ++i) {
        crc = crc >> 8 ^ tables[0][(crc ^ static_cast<unsigned char>(bytes[i])) & 0xff];
    }
    return ~crc;
}

void append_big_endian(std::string& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes += static_cast<char>(value >> shift & 0xff);
    }
}

} // namespace scc::host
