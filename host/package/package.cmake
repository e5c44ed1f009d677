# The commit that vkpm is built from, what is installed, and the Debian package of that.

# Each build looks the commit up; only if it has changed, the one small file that says it is compiled.
set(VKPM_COMMIT "" CACHE STRING "The commit that --version says; empty: the one that git says")
set(commit ${PROJECT_BINARY_DIR}/commit.cpp)
add_custom_target(commit BYPRODUCTS ${commit} COMMENT "Re-checking the commit" VERBATIM
    COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUTPUT=${commit} -D COMMIT=${VKPM_COMMIT}
        -P ${CMAKE_CURRENT_LIST_DIR}/commit.cmake)
target_sources(vkpm PRIVATE ${commit})
add_dependencies(vkpm commit)

# The package's version ends in the release that its libraries are of, as in 0.1.0+debian12.
cmake_host_system_information(RESULT system QUERY DISTRIB_INFO)
set(version ${PROJECT_VERSION}+${system_ID}${system_VERSION_ID})

# Documents in Debian's form: licences, with those of what is compiled in, changes (Debian Policy, 12.5 and 12.7) and
# the manual page.
set(documents ${PROJECT_BINARY_DIR}/documents)
file(READ LICENSE copyright)
foreach(library libimgui-dev nlohmann-json3-dev libcli11-dev libglm-dev libvulkan-dev spirv-tools)
    if(EXISTS /usr/share/doc/${library}/copyright)
        file(READ /usr/share/doc/${library}/copyright licence)
        string(APPEND copyright "\n\nParts of ${library} are compiled into vkpm. Their licence:\n\n${licence}")
    endif()
endforeach()
file(WRITE ${documents}/copyright "${copyright}")
file(READ host/package/changelog changes)
string(REPLACE "(${PROJECT_VERSION})" "(${version})" changes "${changes}")
file(WRITE ${documents}/changelog "${changes}")
file(COPY host/package/vkpm.1 DESTINATION ${documents})
execute_process(COMMAND gzip -9nf changelog vkpm.1 WORKING_DIRECTORY ${documents})
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS LICENSE host/package/changelog host/package/vkpm.1)

file(GLOB scenes CONFIGURE_DEPENDS scenes/*.json scenes/*.obj scenes/*.hdr scenes/*.png)
install(TARGETS vkpm DESTINATION bin)
install(FILES ${scenes} DESTINATION share/vkpm/scenes)
install(FILES README.md host/continuous_integration.md ${documents}/copyright ${documents}/changelog.gz
    DESTINATION share/doc/vkpm)
install(FILES ${documents}/vkpm.1.gz DESTINATION share/man/man1)

# cpack packs what is built, and builds nothing itself.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
file(STRINGS tools/setup driver REGEX "^driver_major=")
string(REPLACE "driver_major=" "" driver ${driver})
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vkpm)
set(CPACK_PACKAGE_VERSION ${version})
set(CPACK_PACKAGE_CONTACT "The vkpm authors <vkpm@vkpm.invalid>" CACHE STRING "The package's maintainer")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "photon mapping renderer in Vulkan compute")
set(CPACK_PACKAGE_DESCRIPTION [[
vkpm renders scenes of rectangles, spheres and meshes with diffuse, mirror
and glass materials, with or without a window. It traces photons from the
lights and reads the light of a scene from their map. A GPU makes it fast,
but a Vulkan driver for the processor is enough.

Scenes to begin with are in /usr/share/vkpm/scenes.]])
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "mesa-vulkan-drivers (>= ${driver})") # beside libraries, a driver that works anywhere
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS fonts-dejavu-core)                 # for the window
include(CPack)
