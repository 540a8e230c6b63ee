# SPDX-License-Identifier: Apache-2.0
# `cmake --install <build> --component programs --prefix <folder>`: dtof and dtof-study, with their man pages and completions for bash,
# which each program writes from its own table of options.
include(GNUInstallDirs)

foreach(program dtof dtof-study)
  install(TARGETS ${program} COMPONENT programs RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(CODE "
    set(program \"$<TARGET_FILE:${program}>\")
    set(texts \"${PROJECT_BINARY_DIR}/texts\")
    file(MAKE_DIRECTORY \"\${texts}\")
    execute_process(COMMAND \"\${program}\" --man OUTPUT_FILE \"\${texts}/${program}.1\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"\${program}\" --completion bash OUTPUT_FILE \"\${texts}/${program}\" COMMAND_ERROR_IS_FATAL ANY)
    file(INSTALL \"\${texts}/${program}.1\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
    file(INSTALL \"\${texts}/${program}\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/bash-completion/completions\")
  " COMPONENT programs)
endforeach()
