#include "runtime/host/read_image.h"

#include <dlfcn.h>
#include <filesystem>

namespace scc::host {

namespace {

using ReadImage = bool (*)(const std::string&, bool, runtime::Image&, std::string&);
using ReadTexels = bool (*)(const std::string&, bool, int, Texels&, std::string&);

/// A function of the module, which lies beside an installed scc, else where it was built.
void* load_from_module(const char* name) {
    std::error_code error;
    const std::filesystem::path prefix =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path().parent_path();
    for (const std::filesystem::path& file :
         {prefix / "lib/scc" / SCC_READ_IMAGE_MODULE_NAME, std::filesystem::path(SCC_READ_IMAGE_MODULE)}) {
        if (void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
            if (void* function = ::dlsym(module, name)) {
                return function;
            }
        }
    }
    const char* reason = ::dlerror();
    throw FileError(std::string("images cannot be read here: ") + (reason != nullptr ? reason : "no module"));
}

} // namespace

runtime::Image read_image(const std::string& path, bool linear_integers) {
    static const auto read = reinterpret_cast<ReadImage>(load_from_module("scc_read_image"));
    runtime::Image image;
    std::string error;
    if (!read(path, linear_integers, image, error)) {
        throw FileError("cannot read `" + path + "`: " + error);
    }
    return image;
}

std::string read_texels(const std::string& path, bool linear_integers, int largest, Texels& texels) {
    static const auto read = reinterpret_cast<ReadTexels>(load_from_module("scc_read_texels"));
    std::string error;
    return read(path, linear_integers, largest, texels, error) ? "" : error;
}

} // namespace scc::host
