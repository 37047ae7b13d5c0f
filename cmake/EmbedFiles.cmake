# cmake -DOUTPUT=x.cpp -DFUNCTION=console_files -DROOT=folder -DFILES=a|b -P EmbedFiles.cmake: the files as C++, for
# app/console/embedded_files.hpp.
string(REPLACE "|" ";" FILES "${FILES}")
set(arrays "")
set(table "")
set(number 0)
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH path "${ROOT}" "${file}")
  file(READ "${file}" bytes HEX)
  file(SHA256 "${file}" sum)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char kFile${number}[] = {${bytes}0};\n")
  string(APPEND table "    {\"/${path}\", text(kFile${number}, sizeof kFile${number} - 1), \"${sum}\"},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE "${OUTPUT}" "// Made by cmake/EmbedFiles.cmake.
#include \"app/console/embedded_files.hpp\"

#include <array>
#include <cstddef>

namespace footlight::app {
namespace {

${arrays}
std::string_view text(const unsigned char* bytes, std::size_t size) { return {reinterpret_cast<const char*>(bytes), size}; }

}  // namespace

std::span<const EmbeddedFile> ${FUNCTION}();
std::span<const EmbeddedFile> ${FUNCTION}() {
  static const std::array<EmbeddedFile, ${number}> kFiles{{
${table}  }};
  return kFiles;
}

}  // namespace footlight::app
")
