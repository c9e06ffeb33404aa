# As it stands this port packs the sources that it lies in. Copied to another place, it fetches them:
#
#   vcpkg_from_git(OUT_SOURCE_PATH SOURCE_PATH URL <your copy of the repository> REF <commit>)
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES learn WISP_BUILD_LEARN)
string(COMPARE EQUAL "${VCPKG_LIBRARY_LINKAGE}" "dynamic" shared)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    ${features}
    # The layers are static libraries; the C ABI is the one that may be shared.
    -DBUILD_SHARED_LIBS=OFF
    -DWISP_BUILD_SHARED=${shared}
    -DWISP_BUILD_TESTS=OFF
    -DWISP_BUILD_APPS=OFF
    -DWISP_BUILD_MEDIA=OFF
    -DWISP_BUILD_MATFILE=OFF
    -DWISP_BUILD_SIMULATE=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/wisp)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/share/doc" "${CURRENT_PACKAGES_DIR}/debug/include"
  "${CURRENT_PACKAGES_DIR}/debug/share")
file(INSTALL "${CURRENT_PORT_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/third_party/NOTICES.txt"
  "${SOURCE_PATH}/third_party/flatbuffers/LICENSE")
