# Packs Wisp by its port for vcpkg where vcpkg is not: its functions that the port calls are played here, by their
# documentation, release alone.
#
#   cmake -DROOT=… -DWORK=… -DLINKAGE=static|dynamic [-DFEATURES=learn] -P vcpkg.cmake       the package: WORK/package
cmake_minimum_required(VERSION 3.25)

set(PORT wisp)
set(VCPKG_LIBRARY_LINKAGE ${LINKAGE})
set(CURRENT_PORT_DIR ${ROOT}/packaging/vcpkg/wisp)
set(CURRENT_PACKAGES_DIR ${WORK}/package)

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(failed)
    message(FATAL_ERROR "the port: ${ARGV} failed:\n${said}")
  endif()
endfunction()

# Names that the port may pass, and no others: vcpkg refuses them too.
macro(only_known)
  if(DEFINED GIVEN_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "the port passes ${GIVEN_UNPARSED_ARGUMENTS}, which vcpkg does not know")
  endif()
endmacro()

function(vcpkg_check_features)
  cmake_parse_arguments(PARSE_ARGV 0 GIVEN "" OUT_FEATURE_OPTIONS "FEATURES;INVERTED_FEATURES")
  only_known()
  set(options "")
  while(GIVEN_FEATURES)
    list(POP_FRONT GIVEN_FEATURES feature option)
    if(feature IN_LIST FEATURES)
      list(APPEND options -D${option}=ON)
    else()
      list(APPEND options -D${option}=OFF)
    endif()
  endwhile()
  set(${GIVEN_OUT_FEATURE_OPTIONS} ${options} PARENT_SCOPE)
endfunction()

function(vcpkg_cmake_configure)
  cmake_parse_arguments(PARSE_ARGV 0 GIVEN "" "SOURCE_PATH;GENERATOR" "OPTIONS;OPTIONS_DEBUG;OPTIONS_RELEASE")
  only_known()
  string(COMPARE EQUAL ${LINKAGE} dynamic shared)
  run(${CMAKE_COMMAND} -S ${GIVEN_SOURCE_PATH} -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR} -DCMAKE_INSTALL_LIBDIR:STRING=lib -DCMAKE_INSTALL_BINDIR:STRING=bin
    -DBUILD_SHARED_LIBS=${shared} -DCMAKE_EXPORT_NO_PACKAGE_REGISTRY=ON ${GIVEN_OPTIONS} ${GIVEN_OPTIONS_RELEASE})
endfunction()

function(vcpkg_cmake_install)
  run(${CMAKE_COMMAND} --build ${WORK}/build --target install)
endfunction()

# Package files move to share/PORT, one folder nearer to the prefix, and what leads back there is written anew.
function(vcpkg_cmake_config_fixup)
  cmake_parse_arguments(PARSE_ARGV 0 GIVEN "DO_NOT_DELETE_PARENT_CONFIG_PATH;NO_PREFIX_CORRECTION" "PACKAGE_NAME;CONFIG_PATH" "")
  only_known()
  set(share ${CURRENT_PACKAGES_DIR}/share/${PORT})
  file(GLOB files ${CURRENT_PACKAGES_DIR}/${GIVEN_CONFIG_PATH}/*)
  if(NOT files)
    message(FATAL_ERROR "the port: there are no package files in ${GIVEN_CONFIG_PATH}")
  endif()
  file(COPY ${files} DESTINATION ${share})
  cmake_path(GET GIVEN_CONFIG_PATH PARENT_PATH parent)
  file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/${parent})
  file(GLOB files ${share}/*.cmake)
  set(up "get_filename_component(_IMPORT_PREFIX \"\${_IMPORT_PREFIX}\" PATH)")
  foreach(file IN LISTS files)
    file(READ ${file} text)
    string(REPLACE "${up}\n${up}\n${up}\n" "${up}\n${up}\n" text "${text}")
    string(REPLACE "\${CMAKE_CURRENT_LIST_DIR}/../../../" "\${CMAKE_CURRENT_LIST_DIR}/../../" text "${text}")
    file(WRITE ${file} "${text}")
  endforeach()
endfunction()

function(vcpkg_fixup_pkgconfig)
endfunction()

function(vcpkg_install_copyright)
  cmake_parse_arguments(PARSE_ARGV 0 GIVEN "" COMMENT FILE_LIST)
  only_known()
  set(all "")
  foreach(file IN LISTS GIVEN_FILE_LIST)
    file(READ ${file} text)
    string(APPEND all "${text}\n")
  endforeach()
  file(WRITE ${CURRENT_PACKAGES_DIR}/share/${PORT}/copyright "${all}")
endfunction()

file(REMOVE_RECURSE ${WORK})
include(${CURRENT_PORT_DIR}/portfile.cmake)

file(READ ${CURRENT_PORT_DIR}/vcpkg.json manifest)
string(JSON named GET "${manifest}" version)
file(STRINGS ${ROOT}/CMakeLists.txt project REGEX "^project\\(wisp VERSION ${named} ")
if(NOT project)
  message(FATAL_ERROR "the port's vcpkg.json says version ${named}, and CMakeLists.txt another")
endif()
# What vcpkg looks for in a package when it is made.
foreach(must IN ITEMS include/wisp/wisp.h share/wisp/wisp-config.cmake share/wisp/copyright share/wisp/usage)
  if(NOT EXISTS ${CURRENT_PACKAGES_DIR}/${must})
    message(FATAL_ERROR "the port's package has no ${must}")
  endif()
endforeach()
