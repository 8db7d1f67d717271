#include "runtime/host/read_image.h"

#include <dlfcn.h>
#include <filesystem>

namespace scc::host {

namespace {

using ReadImage = bool (*)(const std::string&, bool, runtime::Image&, std::string&);

/// Beside an installed scc, else where it was built.
ReadImage load_module() {
    std::error_code error;
    const std::filesystem::path prefix =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path().parent_path();
    for (const std::filesystem::path& file :
         {prefix / "lib/scc" / SCC_READ_IMAGE_MODULE_NAME, std::filesystem::path(SCC_READ_IMAGE_MODULE)}) {
        if (void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
            if (void* function = ::dlsym(module, "scc_read_image")) {
                return reinterpret_cast<ReadImage>(function);
            }
        }
    }
    const char* reason = ::dlerror();
    throw FileError(std::string("images cannot be read here: ") + (reason != nullptr ? reason : "no module"));
}

} // namespace

runtime::Image read_image(const std::string& path, bool linear_integers) {
    static const ReadImage read = load_module();
    runtime::Image image;
    std::string error;
    if (!read(path, linear_integers, image, error)) {
        throw FileError("cannot read `" + path + "`: " + error);
    }
    return image;
}

} // namespace scc::host
