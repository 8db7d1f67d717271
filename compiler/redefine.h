#pragma once

#include "runtime/host/program.h"

#include <string>

/// Programs that take other values of their scene's `param`s: they hold the scene's texts and are linked with
/// the front end.
namespace scc::compiler {

/// Runs the front end over the texts with other definitions and gives the values (CppProgram::values), if
/// they fit the program's code. Fills host::Program::redefine of generated programs.
std::string redefine(const host::Redefinition& wanted);

} // namespace scc::compiler
