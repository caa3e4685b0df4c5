# Compiles resources/FOLDER/*.KIND.json into the core, so that what is built in needs no files at run time.
# `header` declares `struct`, {name, title, text}, and `list`, which returns them all.
function(clothlab_embed output folder kind header struct list)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/resources/${folder}/*.${kind}.json)
  list(TRANSFORM files REPLACE "\\.${kind}\\.json$" "")
  list(SORT files)  # by name: a sister "ball-wool" behind "ball"
  list(TRANSFORM files APPEND ".${kind}.json")
  set(code "#include \"${header}\"\n\nnamespace cloth {\n\nconst std::vector<${struct}>& ${list}() {\n  static const std::vector<${struct}> all{\n")
  foreach(file ${files})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME)
    string(REPLACE ".${kind}.json" "" name ${name})
    file(READ ${file} text)
    string(JSON title GET "${text}" title)
    string(APPEND code "      {\"${name}\", R\"json(${title})json\", R\"json(${text})json\"},\n")
  endforeach()
  string(APPEND code "  };\n  return all;\n}\n\n}  // namespace cloth\n")
  file(CONFIGURE OUTPUT ${output} CONTENT "${code}" @ONLY)
endfunction()
