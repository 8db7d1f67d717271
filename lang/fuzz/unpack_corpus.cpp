#include "lang/fuzz/corpus.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

/// unpack_corpus CORPUS FOLDER: a file for each text, as the fuzzers want them.
int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: unpack_corpus CORPUS FOLDER\n";
        return 2;
    }
    std::ifstream file(argv[1], std::ios::binary);
    const std::string corpus{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    std::filesystem::create_directories(argv[2]);
    int number = 0;
    for (const std::string_view text : scc::lang::fuzz::texts_of(corpus)) {
        std::ofstream(std::filesystem::path(argv[2]) / std::to_string(number++), std::ios::binary) << text;
    }
    return number > 0 ? 0 : 1;
}
