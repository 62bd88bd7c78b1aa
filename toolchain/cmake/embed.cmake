# Puts the files of a folder into a program, under gzip: a C++ source that defines `std::span<const File> embedded_files()` in
# NAMESPACE, where HEADER declares it and `struct File {std::string_view path, etag, packed; bool is_hashed;}`.
#   adit_embed(page_files.cpp HEADER page/site.hpp NAMESPACE adit::page FOLDER served MADE served.made)
# MADE is a file that is newer than all of them: they may have been made during the build, under names that only they know.
# FILES, instead of all, the named ones alone. A file whose name holds a hash (page.5c3a1f2e9b70.js) never changes under that name.
# This file is also the script that writes that source at build time.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  function(adit_embed output)
    cmake_parse_arguments(EMBED "" "HEADER;NAMESPACE;FOLDER;MADE" "FILES" ${ARGN})
    set(script ${PROJECT_SOURCE_DIR}/toolchain/cmake/embed.cmake)
    list(TRANSFORM EMBED_FILES PREPEND ${EMBED_FOLDER}/ OUTPUT_VARIABLE paths)
    string(REPLACE ";" "," names "${EMBED_FILES}")
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${EMBED_HEADER} -DNAMESPACE=${EMBED_NAMESPACE}
              -DFOLDER=${EMBED_FOLDER} -DFILES=${names} -P ${script}
      DEPENDS ${script} ${paths} ${EMBED_MADE}
      COMMENT "Embedding ${EMBED_FOLDER}"
      VERBATIM)
  endfunction()
  return()
endif()

string(REPLACE "," ";" FILES "${FILES}")
if(NOT FILES)
  file(GLOB FILES RELATIVE ${FOLDER} ${FOLDER}/*)  # sorted
endif()
set(bodies "")
set(table "")
foreach(name IN LISTS FILES)
  string(MAKE_C_IDENTIFIER "${name}" identifier)
  configure_file(${FOLDER}/${name} ${OUTPUT}.packed COPYONLY)
  execute_process(COMMAND libdeflate-gzip -12 -f ${OUTPUT}.packed COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUTPUT}.packed.gz bytes HEX)
  file(SHA256 ${FOLDER}/${name} hash)
  string(SUBSTRING ${hash} 0 16 etag)
  if(name MATCHES "\\.[0-9a-f]+\\.(js|css)$")
    set(is_hashed true)
  else()
    set(is_hashed false)
  endif()
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
  # A literal may be no longer than 65,535 characters (C++ [implimits]): in pieces, which the compiler joins.
  string(REGEX REPLACE "((\\\\x..)(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?)" "\"\\1\"\n" bytes "${bytes}")
  string(APPEND bodies "constexpr char k_${identifier}[] =\n${bytes};\n")
  string(APPEND table
    "    {\"/${name}\", \"${etag}\", {k_${identifier}, sizeof k_${identifier} - 1}, ${is_hashed}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Written by toolchain/cmake/embed.cmake.
#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {

${bodies}
constexpr File kFiles[] = {
${table}};

}  // namespace

std::span<const File> embedded_files() { return kFiles; }

}  // namespace ${NAMESPACE}
")
