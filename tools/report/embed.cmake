# cmake -DOUT=FILE.cpp -DFROM=DIR -P embed.cmake: the template's files as C++.
file(WRITE ${OUT}.new "#include \"tools/report/page_template.h\"\n\nnamespace lcs::report {\n")
foreach(name Html Css Js)
  string(TOLOWER ${name} extension)
  # As bytes: text of any length and with any characters.
  file(READ ${FROM}/page.${extension} bytes HEX)
  string(LENGTH "${bytes}" size)
  math(EXPR size "${size} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text "static constexpr char k${name}Bytes[] = {${bytes}};\n"
    "const std::string_view kPage${name}(k${name}Bytes, ${size});\n")
endforeach()
file(APPEND ${OUT}.new "${text}}  // namespace lcs::report\n")
file(RENAME ${OUT}.new ${OUT})
