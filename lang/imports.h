#pragma once

#include "lang/ast.h"
#include "lang/checker.h"
#include "lang/frame.h"
#include "lang/importer.h"
#include "lang/value.h"

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace scc::lang {

/// One `import`: a file with values of its own for its params. The same file imported twice is two of these.
struct ImportedFile {
    std::string name; ///< after `as`
    Span span;        ///< of that name
    std::shared_ptr<const ast::File> tree;
    CheckedFile code;
    FramePtr globals; ///< within that of the importing file, where the values of `with` are computed
    Value scene;      ///< `name.scene`, once it is evaluated
    const Constructor* group = nullptr; ///< of the shapes in it
};

/// What all files of one scene share while they are checked.
struct ImportSession {
    struct OpenFile {
        std::string identity;
        std::string path;
        Span import; ///< of the path, in the file before
    };
    struct Tree {
        FileId file;
        std::shared_ptr<const ast::File> tree;
    };

    Importer* importer = nullptr;      ///< null: nothing can be imported
    std::vector<OpenFile> open;        ///< the scene's own file, then each that the next one is imported by
    std::map<std::string, Tree> trees; ///< by identity: a file is read and parsed once
    std::size_t count = 0;
};

/// An import as the importing file's checker sees it: the names of the imported file with their types.
struct ImportedNames {
    Checker checker;
    ImportedFile* file;
};

} // namespace scc::lang
