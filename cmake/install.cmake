# What `cmake --install` puts where: libraries, headers, pkg-config files, a CMake package, the command.
#
# Each library has an export set of its own, so that find_package(asperity COMPONENTS core) asks for
# nothing but libm.

set(ASPERITY_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/asperity)

# Shared libraries show the public names, and apart from them those that the command needs.
if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
  foreach(library asperity asperity_data asperity_draw)
    if(TARGET ${library})
      target_link_options(${library} PRIVATE
        "LINKER:--version-script=${CMAKE_CURRENT_LIST_DIR}/exported.map")
      set_target_properties(${library} PROPERTIES
        LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/exported.map)
    endif()
  endforeach()
endif()

set_target_properties(asperity PROPERTIES EXPORT_NAME asperity)
install(TARGETS asperity EXPORT asperity-core)
install(EXPORT asperity-core NAMESPACE asperity:: DESTINATION ${ASPERITY_PACKAGE_DIR})
install(FILES include/asperity.h include/asperity_ndf.h include/asperity_study.h include/asperity_convert.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY include/asperity DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")


# asperity_pc(NAME DESCRIPTION LIBRARY REQUIRES PRIVATE_REQUIRES PRIVATE_LIBS)
function(asperity_pc name description library requires private_requires private_libs)
  set(text "prefix=\${pcfiledir}/../..\nincludedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}\n")
  string(APPEND text "libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}\n\n")
  string(APPEND text "Name: ${name}\nDescription: ${description}\nVersion: ${PROJECT_VERSION}\n")
  if(BUILD_SHARED_LIBS)
    string(APPEND text "Requires: ${requires}\nRequires.private: ${private_requires}\n")
    string(APPEND text "Libs: -L\${libdir} -l${library}\nLibs.private: ${private_libs}\n")
  else()
    string(APPEND text "Requires: ${requires} ${private_requires}\n")
    string(APPEND text "Libs: -L\${libdir} -l${library} ${private_libs}\n")
  endif()
  string(APPEND text "Cflags: -I\${includedir}\n")
  # the folder of the .pc file may be lib/<triplet>/pkgconfig: one more step up to the prefix
  string(REGEX REPLACE "[^/]+" ".." up "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
  string(REPLACE "\${pcfiledir}/../.." "\${pcfiledir}/${up}" text "${text}")
  file(WRITE ${CMAKE_BINARY_DIR}/pkgconfig/${name}.pc "${text}")
  install(FILES ${CMAKE_BINARY_DIR}/pkgconfig/${name}.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

asperity_pc(asperity "Microfacet surface appearance: distributions, masking, scattering"
  asperity "" "" "-lm")

if(TARGET asperity_data)
  set_target_properties(asperity_data PROPERTIES EXPORT_NAME data)
  set_target_properties(asperity_draw PROPERTIES EXPORT_NAME draw)
  install(TARGETS asperity_data EXPORT asperity-data)
  install(TARGETS asperity_draw EXPORT asperity-draw)
  install(EXPORT asperity-data NAMESPACE asperity:: DESTINATION ${ASPERITY_PACKAGE_DIR})
  install(EXPORT asperity-draw NAMESPACE asperity:: DESTINATION ${ASPERITY_PACKAGE_DIR})
  install(FILES include/asperity_data.h include/asperity_draw.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(TARGETS asperity_command)
  asperity_pc(asperity-data "Measured reflectance, height fields, fitting" asperity_data
    "asperity" "jansson cminpack" "-lembree3 -pthread -lm")
  asperity_pc(asperity-draw "Charts, images and previews of surface appearance" asperity_draw
    "asperity-data" "libpng OpenEXR" "-pthread -lm")
endif()

if(BUILD_SHARED_LIBS)
  set(ASPERITY_STATIC FALSE)
else()
  set(ASPERITY_STATIC TRUE)
endif()
configure_package_config_file(cmake/asperityConfig.cmake.in
  ${CMAKE_BINARY_DIR}/asperityConfig.cmake INSTALL_DESTINATION ${ASPERITY_PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/asperityConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/asperityConfig.cmake
  ${CMAKE_BINARY_DIR}/asperityConfigVersion.cmake DESTINATION ${ASPERITY_PACKAGE_DIR})
