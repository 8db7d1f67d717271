#pragma once

#include "compiler/ir/function.h"
#include "runtime/function.h"

namespace scc::compiler {

/// The function for the runtime's interpreter: register i is node i.
template <class R>
runtime::FunctionProgram<R> program_of(const ir::Function& function) {
    runtime::FunctionProgram<R> program;
    for (const ir::Node& node : function.nodes) {
        runtime::Instruction<R> instruction;
        switch (node.kind) {
        case ir::Node::Kind::constant:
            instruction.code = runtime::Opcode::constant;
            instruction.constant = static_cast<R>(node.constant);
            break;
        case ir::Node::Kind::input:
            instruction.code = static_cast<runtime::Opcode>(static_cast<int>(runtime::Opcode::p_x) +
                                                            static_cast<int>(node.input));
            break;
        case ir::Node::Kind::apply:
            instruction.code = static_cast<runtime::Opcode>(static_cast<int>(runtime::Opcode::image) + 1 +
                                                            static_cast<int>(node.op));
            instruction.operands = node.operands;
            break;
        case ir::Node::Kind::image:
            instruction.code = runtime::Opcode::image;
            instruction.operands = {node.operands[0], node.operands[1],
                                    runtime::channel_of(node.image, node.channel)};
            break;
        }
        program.instructions.push_back(instruction);
    }
    program.results = function.results;
    for (const std::shared_ptr<const ir::Image>& image : function.images) {
        program.images.push_back(image->data);
    }
    return program;
}

} // namespace scc::compiler
