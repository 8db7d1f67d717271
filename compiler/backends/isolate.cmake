# Code for more than the machine's baseline, in a program that must run without it.
#
# An inline function or template is compiled into every object that uses it, and the linker keeps one copy for all. A
# copy with AVX instructions must not become the one that the rest of the program calls. So each object that is compiled
# for a larger instruction set is linked by itself, its sections taken out of their groups, and all its symbols but one
# function made local.

set(SCC_CAN_ISOLATE OFF)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 8 AND CMAKE_LINKER AND CMAKE_OBJCOPY
   AND NOT SCC_SANITIZE)
    execute_process(COMMAND ${CMAKE_LINKER} --help OUTPUT_VARIABLE linker_help ERROR_QUIET)
    if(linker_help MATCHES "--force-group-allocation")
        set(SCC_CAN_ISOLATE ON)
    endif()
endif()

# scc_isolate(TARGET FUNCTION OBJECT_LIBRARY): adds the library's one object to the target, with FUNCTION, an extern "C"
# one, as all that can be linked with.
function(scc_isolate target function object_library)
    set(isolated ${CMAKE_CURRENT_BINARY_DIR}/${object_library}.o)
    add_custom_command(
        OUTPUT ${isolated}
        DEPENDS ${object_library} $<TARGET_OBJECTS:${object_library}>
        COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${isolated} $<TARGET_OBJECTS:${object_library}>
        COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${function} ${isolated}
        VERBATIM)
    target_sources(${target} PRIVATE ${isolated})
    set_property(GLOBAL APPEND PROPERTY SCC_ISOLATED_OBJECTS ${isolated})
endfunction()
