# Packages from npm, for what is built or tested with Node.js. They are installed in the build folder,
# so that the source tree stays as it is.

find_program(NODE_PROGRAM NAMES node nodejs DOC "Node.js, 18 or later")
find_program(NPM_PROGRAM npm DOC "npm, which comes with Node.js or beside it")

# biotomy_check_node(PURPOSE HOW-TO-DO-WITHOUT)
# Fails, in one line, where Node.js or npm is missing or too old.
function(biotomy_check_node purpose without)
  if(NOT NODE_PROGRAM OR NOT NPM_PROGRAM)
    message(FATAL_ERROR "${purpose} needs node and npm: install nodejs and npm (scripts/bootstrap does), or ${without}")
  endif()
  execute_process(COMMAND ${NODE_PROGRAM} --version OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REGEX REPLACE "^v" "" version "${version}")
  if(version VERSION_LESS 18)
    message(FATAL_ERROR "${purpose} needs node 18 or later, ${NODE_PROGRAM} is ${version}: install nodejs, or ${without}")
  endif()
endfunction()

# biotomy_npm_packages(STAMP SOURCE DESTINATION)
# Puts what SOURCE/package-lock.json names into DESTINATION/node_modules, anew when it changed. STAMP
# is the variable for the file to depend on.
function(biotomy_npm_packages stamp source destination)
  set(file ${destination}/node_modules/.package-lock.json)
  add_custom_command(
    OUTPUT ${file}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${destination}
    COMMAND ${CMAKE_COMMAND} -E copy ${source}/package.json ${source}/package-lock.json ${source}/.npmrc ${destination}
    COMMAND ${CMAKE_COMMAND} -E chdir ${destination} ${NPM_PROGRAM} ci --ignore-scripts --no-fund --no-audit --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${file}
    DEPENDS ${source}/package.json ${source}/package-lock.json ${source}/.npmrc
    COMMENT "Installing the npm packages of ${destination}"
    VERBATIM)
  set(${stamp} ${file} PARENT_SCOPE)
endfunction()
