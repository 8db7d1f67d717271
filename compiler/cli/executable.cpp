#include "compiler/cli/executable.h"

#include "runtime/host/file.h"

#include <cstring>
#include <elf.h>
#include <string_view>

namespace scc::cli {

namespace {

/// Reads within the file's bounds.
class Reader {
public:
    Reader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

    template <class T>
    T at(std::uint64_t offset) const {
        if (offset > bytes_.size() || bytes_.size() - offset < sizeof(T)) {
            fail();
        }
        T value;
        std::memcpy(&value, bytes_.data() + offset, sizeof value);
        return value;
    }
    std::string text(std::uint64_t offset) const {
        const std::size_t end = offset < bytes_.size() ? bytes_.find('\0', offset) : std::string_view::npos;
        if (end == std::string_view::npos) {
            fail();
        }
        return std::string(bytes_.substr(offset, end - offset));
    }
    [[noreturn]] void fail() const {
        throw host::FileError("`" + path_ + "` is no program of this machine's kind");
    }

private:
    std::string_view bytes_;
    const std::string& path_;
};

} // namespace

Executable inspect_executable(const std::string& path) {
    const host::MappedFile file(path);
    const Reader reader(file.text(), path);
    const auto head = reader.at<Elf64_Ehdr>(0);
    if (std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_ident[EI_CLASS] != ELFCLASS64) {
        reader.fail();
    }
    const auto section = [&](std::uint64_t index) {
        return reader.at<Elf64_Shdr>(head.e_shoff + index * sizeof(Elf64_Shdr));
    };
    Executable result;
    for (std::uint64_t i = 0; i < head.e_shnum; ++i) {
        const Elf64_Shdr one = section(i);
        if ((one.sh_flags & SHF_EXECINSTR) != 0) {
            result.code_bytes += one.sh_size;
        }
        if (one.sh_type == SHT_DYNAMIC) {
            const std::uint64_t names = section(one.sh_link).sh_offset;
            for (std::uint64_t at = 0; at + sizeof(Elf64_Dyn) <= one.sh_size; at += sizeof(Elf64_Dyn)) {
                const auto entry = reader.at<Elf64_Dyn>(one.sh_offset + at);
                if (entry.d_tag == DT_NEEDED) {
                    result.libraries.push_back(reader.text(names + entry.d_un.d_val));
                }
            }
        }
    }
    return result;
}

} // namespace scc::cli
