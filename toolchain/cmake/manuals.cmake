# Man pages, and completion for bash, zsh and fish, of what each program says of itself (toolchain/manuals): made with all else,
# and installed. A box has nobody to read them, and no man: what ships as an image is built without (ADIT_MANUALS=OFF).
find_program(ADIT_PYTHON3 python3)
if(CMAKE_CROSSCOMPILING OR CMAKE_INTERPROCEDURAL_OPTIMIZATION OR NOT ADIT_PYTHON3)
  set(manuals_usual OFF)
else()
  set(manuals_usual ON)
endif()
option(ADIT_MANUALS "Make man pages and completion for shells" ${manuals_usual})
if(ADIT_MANUALS)
  set(programs adit aditd adit-network adit-import adit-update adit-clock adit-spare adit-certificate adit-panel)
  if(ADIT_REHEARSAL)
    list(APPEND programs adit-rehearsal adit-robots)
  endif()
  list(TRANSFORM programs REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE files)
  set(example ${PROJECT_SOURCE_DIR}/firmware/rules/settings/example.json)
  file(GLOB makers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/toolchain/manual/*.py)
  add_custom_command(OUTPUT manuals.made
    COMMAND ${CMAKE_COMMAND} -E rm -rf manuals
    COMMAND ${ADIT_PYTHON3} -B ${PROJECT_SOURCE_DIR}/toolchain/manuals manuals ${example} ${files}
    COMMAND ${CMAKE_COMMAND} -E touch manuals.made
    DEPENDS ${programs} ${example} ${makers} ${PROJECT_SOURCE_DIR}/toolchain/manuals VERBATIM)
  add_custom_target(manuals ALL DEPENDS manuals.made)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/manuals/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT manuals OPTIONAL)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/manuals/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT manuals OPTIONAL PATTERN man EXCLUDE)
endif()
