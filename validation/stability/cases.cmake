# The scenes of the stability suite as one C++ source file, so that an installed scc holds them. Its path is appended to
# the variable `list`.
function(scc_case_texts list)
    file(GLOB cases CONFIGURE_DEPENDS "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/cases/*.scn")
    set(case_texts "")
    foreach(path IN LISTS cases)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
        get_filename_component(name "${path}" NAME_WE)
        file(READ "${path}" text)
        string(APPEND case_texts "    {\"${name}\", R\"scn(${text})scn\"},\n")
    endforeach()
    configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/case_texts.cpp.in" "${CMAKE_CURRENT_BINARY_DIR}/case_texts.cpp" @ONLY)
    set(${list} ${${list}} "${CMAKE_CURRENT_BINARY_DIR}/case_texts.cpp" PARENT_SCOPE)
endfunction()
