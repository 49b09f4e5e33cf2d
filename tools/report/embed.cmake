# cmake -DOUT=FILE.cpp -DHEADER=FILE.h -DNAMESPACE=NAME -DFILES=NAME=FILE,... -P embed.cmake: files as
# C++, each a string_view of that name, declared by the header.
file(WRITE ${OUT}.new "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
string(REPLACE "," ";" FILES "${FILES}")
foreach(entry ${FILES})
  string(REGEX MATCH "^([^=]*)=(.*)$" entry "${entry}")
  set(name ${CMAKE_MATCH_1})
  # As bytes: text of any length and with any characters.
  file(READ ${CMAKE_MATCH_2} bytes HEX)
  string(LENGTH "${bytes}" size)
  math(EXPR size "${size} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text "static constexpr char ${name}Bytes[] = {${bytes}};\n"
    "const std::string_view ${name}(${name}Bytes, ${size});\n")
endforeach()
file(APPEND ${OUT}.new "${text}}  // namespace ${NAMESPACE}\n")
file(RENAME ${OUT}.new ${OUT})
