# Puts files into a program, under gzip: a C++ source that defines `std::span<const File> embedded_files()` in NAMESPACE,
# where HEADER declares it and `struct File {std::string_view path, etag, packed;}`.
#   adit_embed(page_files.cpp HEADER page/site.hpp NAMESPACE adit::page FOLDER files FILES index.html page.css LIST words.inc)
# LIST is optional: a file with a word in quotes and a comma on each line. Where a script says ["words.inc"], it has all of these.
# This file is also the script that writes that source at build time, whenever one of the files has changed.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  function(adit_embed output)
    cmake_parse_arguments(EMBED "" "HEADER;NAMESPACE;FOLDER;LIST" "FILES" ${ARGN})
    set(script ${PROJECT_SOURCE_DIR}/toolchain/cmake/embed.cmake)
    list(TRANSFORM EMBED_FILES PREPEND ${EMBED_FOLDER}/ OUTPUT_VARIABLE paths)
    string(REPLACE ";" "," names "${EMBED_FILES}")
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${EMBED_HEADER} -DNAMESPACE=${EMBED_NAMESPACE}
              -DFOLDER=${EMBED_FOLDER} -DFILES=${names} -DLIST=${EMBED_LIST} -P ${script}
      DEPENDS ${script} ${paths} ${EMBED_LIST}
      COMMENT "Embedding ${EMBED_FOLDER}"
      VERBATIM)
  endfunction()
  return()
endif()

string(REPLACE "," ";" FILES "${FILES}")
if(LIST)
  file(STRINGS ${LIST} words REGEX "^\"")
  list(JOIN words " " words)
  string(REGEX REPLACE ",$" "" words "${words}")
  get_filename_component(list_name ${LIST} NAME)
endif()
set(bodies "")
set(table "")
foreach(name IN LISTS FILES)
  string(MAKE_C_IDENTIFIER "${name}" identifier)
  file(READ ${FOLDER}/${name} text)
  if(name MATCHES "\\.js$")  # without the lines that are a comment; the others keep their numbers
    string(REGEX REPLACE "\n *(//[^\n]*|/\\*\\*[^\n]*\\*/)" "\n" text "\n${text}")
    string(SUBSTRING "${text}" 1 -1 text)
    if(LIST)
      string(REPLACE "[\"${list_name}\"]" "[${words}]" text "${text}")
    endif()
  elseif(name MATCHES "\\.css$")  # without its comments
    string(REGEX REPLACE " */\\*[^*]*\\*/" "" text "${text}")
  elseif(name MATCHES "\\.html$")  # without what indents its lines
    string(REGEX REPLACE "\n +" "\n" text "${text}")
  endif()
  file(WRITE ${OUTPUT}.packed "${text}")
  execute_process(COMMAND gzip -n9f ${OUTPUT}.packed COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUTPUT}.packed.gz bytes HEX)
  string(SHA256 hash "${text}")
  string(SUBSTRING ${hash} 0 16 etag)
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
  # A literal may be no longer than 65,535 characters (C++ [implimits]): in pieces, which the compiler joins.
  string(REGEX REPLACE "((\\\\x..)(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?)" "\"\\1\"\n" bytes "${bytes}")
  string(APPEND bodies "constexpr char k_${identifier}[] =\n${bytes};\n")
  string(APPEND table
    "    {\"/${name}\", \"\\\"${etag}\\\"\", {k_${identifier}, sizeof k_${identifier} - 1}},\n")
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
