# Debian packages by CPack: `hilcam`, `hilcam-maps` (with GDAL), `hilcam-examples` and `python3-hilcam`. tools/package makes them.
file(STRINGS /etc/os-release release REGEX "^(ID|VERSION_ID)=")
foreach(line ${release})
    if(line MATCHES "^ID=\"?([a-z]+)")
        set(release_id ${CMAKE_MATCH_1})
    elseif(line MATCHES "^VERSION_ID=\"?([0-9.]+)")
        set(release_version ${CMAKE_MATCH_1})
    endif()
endforeach()
if(NOT release_id MATCHES "debian|ubuntu")
    return()
endif()
string(SUBSTRING ${release_id} 0 3 release_id)
set(release_tag 1~${release_id}${release_version})

set(HILCAM_MAINTAINER "hilcam maintainers <maintainers@hilcam.invalid>" CACHE STRING
    "Who answers for the packages, as Debian's control files have it")

# Debian's own files: licences and a changelog of its form.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
find_program(GIT git)
if(GIT AND EXISTS ${PROJECT_SOURCE_DIR}/.git)
    # The commit's time, so that the same commit gives the same package.
    execute_process(COMMAND ${GIT} -C ${PROJECT_SOURCE_DIR} log -1 --format=%cD OUTPUT_VARIABLE now
        OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
set(debian ${CMAKE_BINARY_DIR}/debian)
foreach(package hilcam hilcam-maps hilcam-examples python3-hilcam)
    set(changelog "${package} (${PROJECT_VERSION}-${release_tag}) unstable; urgency=medium\n\n  * Version ${PROJECT_VERSION}; see changelog.gz of hilcam.\n\n -- ${HILCAM_MAINTAINER}  ${now}\n")
    file(WRITE ${debian}/${package}/changelog.Debian "${changelog}")
    configure_file(CHANGELOG.md ${debian}/${package}/changelog COPYONLY)
    execute_process(COMMAND gzip -9nf ${debian}/${package}/changelog.Debian ${debian}/${package}/changelog)
    configure_file(tools/packaging/debian/copyright ${debian}/${package}/copyright COPYONLY)
endforeach()

# The files above in the place of ours, and pages compressed, when CPack has put a component together.
configure_file(tools/packaging/debian/staged.cmake.in ${debian}/staged.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${debian}/staged.cmake)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "hilcam")
set(CPACK_PACKAGE_CONTACT "${HILCAM_MAINTAINER}")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_SOURCE_DIR}/out/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program examples python)
if(HILCAM_GDAL)
    list(APPEND CPACK_COMPONENTS_ALL maps)
    set(maps_package ", hilcam-maps")
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${release_tag})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME hilcam)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
# Plots are made by Python.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "python3:any")
# ZeroMQ is loaded when a scenario has Basilisk for its simulator (io/vizard/reply_socket.cpp), compressions of packets when one is asked
# for (io/system/loaded_library.h).
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "hilcam-examples${maps_package}, libzmq5, python3-matplotlib")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "aravis-tools, aravis-tools-cli, gir1.2-aravis-0.8, libaec0, libcharls2, libopenjp2-7, python3-gi, python3-yaml")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "spacecraft's visible camera for the test bench
hilcam stands in for a spacecraft's visible camera in hardware-in-the-loop
tests. A real-time loop takes poses over UDP, TCP or USB, ray-traces what the
camera would see, puts it through a model of optics, detector and electronics,
and publishes the frames as a GigE Vision camera, a V4L2 device or a USB video
camera.")
set(CPACK_DEBIAN_MAPS_PACKAGE_NAME hilcam-maps)
set(CPACK_DEBIAN_MAPS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MAPS_PACKAGE_DEPENDS "hilcam (= ${PROJECT_VERSION}-${release_tag})")
set(CPACK_COMPONENT_MAPS_DESCRIPTION "maps of the ground for hilcam, by GDAL
The program by which hilcam, a spacecraft's camera for the test bench, reads
GeoTIFF, PDS3, ISIS and ENVI maps in any projection: heights, albedo and other
figures of the ground, and layers of the Earth. Only scenarios that name such
files need it.")
set(CPACK_DEBIAN_EXAMPLES_PACKAGE_NAME hilcam-examples)
set(CPACK_DEBIAN_EXAMPLES_PACKAGE_SECTION science)
set(CPACK_DEBIAN_EXAMPLES_PACKAGE_DEPENDS "hilcam (= ${PROJECT_VERSION}-${release_tag})")
set(CPACK_DEBIAN_EXAMPLES_PACKAGE_SUGGESTS "gir1.2-aravis-0.8, python3-gi, python3-numpy, python3-pil")
set(CPACK_COMPONENT_EXAMPLES_DESCRIPTION "scenarios and example programs for hilcam
Scenarios to start hilcam with, the generator of the spacecraft in them, a
flight program that keeps its target in the middle of the picture (source), and
a client that takes frames through Aravis.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-hilcam)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3:any, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "hilcam, python3-pil")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/tools/packaging/debian/postinst
    ${CMAKE_SOURCE_DIR}/tools/packaging/debian/prerm)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "hilcam from Python: benches, commands, frames, campaigns
Starts benches of hilcam, a spacecraft's camera for the test bench, sends it
commands, reads its frames from shared memory without a copy, its truth as
dataclasses, layers as numpy arrays and campaigns as tables.")
include(CPack)
