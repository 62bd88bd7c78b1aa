# Man pages and bash's completion, made by asking each program for its help: the target manuals. A box has no use for them:
# only `cmake --install ... --component manuals` installs them.
if(NOT CMAKE_CROSSCOMPILING)
  set(programs adit aditd adit-network adit-import adit-update adit-lights)
  if(ADIT_REHEARSAL)
    list(APPEND programs adit-rehearsal adit-robots)
  endif()
  list(TRANSFORM programs REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE files)
  add_custom_target(manuals COMMAND ${PROJECT_SOURCE_DIR}/toolchain/manuals ${PROJECT_BINARY_DIR}/manuals ${files} VERBATIM)
  add_dependencies(manuals ${programs})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/manuals/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT manuals EXCLUDE_FROM_ALL OPTIONAL)
endif()
