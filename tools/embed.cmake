# cmake -DOUT=FILE.cpp -DNAMESPACE=NAME -DFILES=NAME=FILE,... -P embed.cmake writes files as C++
# definitions of string_views with these names. Their users declare them.
file(WRITE ${OUT}.new "#include <string_view>\n\nnamespace ${NAMESPACE} {\n")
string(REPLACE "," ";" FILES "${FILES}")
foreach(entry ${FILES})
  string(REGEX MATCH "^([^=]*)=(.*)$" entry "${entry}")
  set(name ${CMAKE_MATCH_1})
  # Written as bytes, which allows any length and any characters.
  file(READ ${CMAKE_MATCH_2} bytes HEX)
  string(LENGTH "${bytes}" size)
  math(EXPR size "${size} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text "static constexpr char ${name}Bytes[] = {${bytes}};\n"
    "extern const std::string_view ${name};\n"
    "const std::string_view ${name}(${name}Bytes, ${size});\n")
endforeach()
file(APPEND ${OUT}.new "${text}}  // namespace ${NAMESPACE}\n")
file(RENAME ${OUT}.new ${OUT})
