#pragma once

#include "runtime/mesh_data.h"
#include "runtime/texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// A scene's numbers apart from the code that draws it. They are tables one after the other, in the order in
/// which the generated program reads them, each with its rows' size and number before it. `scc build` appends
/// them to the program's file, which maps them at its start: meshes are drawn from where they lie.
namespace scc::host {

class ValuesWriter {
public:
    template <class T>
    void add(std::span<const T> rows) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::byte* to = add_table(sizeof(T), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            T row = rows[i];
            clear_padding(row);
            std::memcpy(to + i * sizeof(T), &row, sizeof(T));
        }
    }
    template <class T>
    void add(const T& value) {
        add(std::span(&value, 1));
    }
    void add_text(std::string_view text) { add(std::span(text.data(), text.size())); }
    void add(const std::vector<runtime::MeshData>& meshes);
    void add(const std::vector<runtime::ImageData>& images);

    bool empty() const { return bytes_.empty(); }
    /// To avoid copies where the size is roughly known.
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
    /// With a seal at the end by which a reader finds and checks them.
    std::string take();
    /// For a place that checks its content itself.
    std::string take_unsealed() { return std::exchange(bytes_, {}); }

private:
    /// The same scene gives the same bytes.
    template <class T>
    static void clear_padding([[maybe_unused]] T& row) {
        if constexpr (requires { row.shape.points; }) {
            // g++ 12 takes members of nested arrays for padding.
            clear_between(&row.shape.smooth + 1, &row.shape.uvs);
            clear_between(&row.shape.has_uvs + 1, &row.shape + 1);
            clear_between(&row.tag + 1, &row + 1);
        } else {
#if defined(__has_builtin)
#if __has_builtin(__builtin_clear_padding)
            __builtin_clear_padding(&row);
#endif
#endif
        }
    }
    static void clear_between(void* begin, void* end) {
        std::memset(begin, 0, static_cast<std::size_t>(static_cast<char*>(end) - static_cast<char*>(begin)));
    }
    std::byte* add_table(std::size_t row_size, std::size_t rows);

    std::string bytes_;
};

/// Reads what a ValuesWriter wrote, in the same order. What does not fit throws FileError.
class Values {
public:
    /// `bytes` ends with the seal; what lies before the values is skipped. They must outlive what is read as
    /// a span. `owner` is named in errors.
    Values(std::span<const std::byte> bytes, std::string owner);
    Values() = default; ///< none
    /// What take_unsealed() gave, known to be whole.
    static Values unsealed(std::string_view bytes, std::string owner);

    template <class T>
    void read(std::span<const T>& rows) {
        std::size_t count = 0;
        const void* data = next(sizeof(T), count);
        rows = {static_cast<const T*>(data), count};
    }
    template <class T, std::size_t n>
    void read(std::array<T, n>& rows) {
        std::memcpy(rows.data(), next_of(sizeof(T), n), n * sizeof(T));
    }
    template <class T>
    void read(T& value) {
        std::memcpy(&value, next_of(sizeof(T), 1), sizeof(T));
    }
    void read(std::vector<runtime::MeshData>& meshes);
    void read(std::vector<runtime::ImageData>& images);
    std::string read_text();

private:
    const void* next(std::size_t row_size, std::size_t& rows);
    const void* next_of(std::size_t row_size, std::size_t rows);
    [[noreturn]] void fail(const char* reason) const;

    std::span<const std::byte> rest_;
    std::string owner_;
};

} // namespace scc::host
