# The fixed part of a Blender export as one C++ source file. Its path is appended to the variable `list`. Each file is a literal
# of its own, since compilers need not take literals of any length.
function(scc_blender_text list)
    set(blender_text "")
    foreach(part nodes surfaces geometry exact artist build main)
        set(path "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/blender/${part}.py")
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
        file(READ "${path}" text)
        string(APPEND blender_text "    R\"py(${text})py\"\n")
    endforeach()
    configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/blender_text.cpp.in" "${CMAKE_CURRENT_BINARY_DIR}/blender_text.cpp" @ONLY)
    set(${list} ${${list}} "${CMAKE_CURRENT_BINARY_DIR}/blender_text.cpp" PARENT_SCOPE)
endfunction()
