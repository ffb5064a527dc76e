# What is installed, and where. Everything is found from where the program lies (io/system/program_files.h), so a prefix
# may be moved whole.
set(data ${CMAKE_INSTALL_DATADIR}/hilcam)
set(doc ${CMAKE_INSTALL_DOCDIR})

# A build tree looks like a prefix to the program: its data are those of the source tree.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/configs ${CMAKE_BINARY_DIR}/share/hilcam SYMBOLIC)

# Manual pages and completion, made by the program out of its own options.
set(pages ${CMAKE_BINARY_DIR}/pages)
add_custom_command(OUTPUT ${pages}/hilcam.bash
    COMMAND $<TARGET_FILE:hilcam> make-pages ${pages}
    DEPENDS hilcam COMMENT "Manual pages and completion" VERBATIM)
add_custom_target(pages ALL DEPENDS ${pages}/hilcam.bash)

# --- the program ---
install(TARGETS hilcam RUNTIME COMPONENT program)
install(PROGRAMS tools/hilcam-plot-campaign tools/hilcam-plot-characterise tools/hilcam-plot-clone tools/hilcam-plot-latency tools/hilcam-plot-soak
    tools/hilcam-plot-tradeoff tools/hilcam-camera-face tools/hilcam-record-frames
    DESTINATION ${HILCAM_INSTALL_HELPERDIR} COMPONENT program)
install(TARGETS hilcam-calibrate-lens RUNTIME DESTINATION ${HILCAM_INSTALL_HELPERDIR} COMPONENT program)
if(HILCAM_GDAL)
    # A package of its own, as GDAL brings a hundred libraries.
    install(TARGETS hilcam-read-map RUNTIME DESTINATION ${HILCAM_INSTALL_HELPERDIR} COMPONENT maps)
endif()
install(DIRECTORY configs/cameras configs/filters configs/maps configs/materials configs/quality configs/schema configs/stars
    DESTINATION ${data} COMPONENT program)
# The modules of hilcam-camera-face.
install(DIRECTORY tools/camera_face DESTINATION ${data} COMPONENT program FILES_MATCHING PATTERN "*.py"
    PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program FILES_MATCHING PATTERN "*.1")
install(FILES ${pages}/hilcam.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME hilcam
    COMPONENT program)
install(FILES tools/packaging/systemd/hilcam@.service DESTINATION lib/systemd/system COMPONENT program)
# What clients in C and plug-ins include: -I PREFIX/include/hilcam.
install(FILES tools/client/hilcam_client.h tools/client/hilcam_shm.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hilcam COMPONENT program)
install(DIRECTORY render DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hilcam COMPONENT program FILES_MATCHING PATTERN "*.h")
install(FILES tools/client/hilcam_client.py DESTINATION ${data}/client COMPONENT program)
install(PROGRAMS tools/client/hilcam_read_packets.py DESTINATION ${data}/client COMPONENT program)
install(FILES README.md CONTRIBUTING.md NOTICE CITATION.cff SECURITY.md DESTINATION ${doc} COMPONENT program)
install(DIRECTORY docs DESTINATION ${doc} COMPONENT program)
install(FILES tools/client/README.md DESTINATION ${doc}/tools/client COMPONENT program)
install(DIRECTORY tools/python DESTINATION ${doc}/tools COMPONENT program PATTERN __pycache__ EXCLUDE)
install(DIRECTORY tools/ground_systems DESTINATION ${doc}/tools COMPONENT program)
install(DIRECTORY tools/image_packets tools/nos3 tools/fprime DESTINATION ${doc}/tools COMPONENT program)
# Debian has a licence file and a changelog of its own kind in their place (debian.cmake).
install(FILES CHANGELOG.md LICENSE DESTINATION ${doc} COMPONENT texts)

# The manual's pages name files as they lie in the source tree. What of those is installed is found beside the pages by the
# same name: a relative link, so that the prefix may be moved.
function(install_name NAME INSTALLED COMPONENT)
    get_filename_component(parent ${doc}/${NAME} DIRECTORY)
    file(RELATIVE_PATH target /${parent} /${INSTALLED})
    set(link ${CMAKE_BINARY_DIR}/names/${NAME})
    get_filename_component(made ${link} DIRECTORY)
    file(MAKE_DIRECTORY ${made})
    file(CREATE_LINK ${target} ${link} SYMBOLIC)
    install(FILES ${link} DESTINATION ${parent} COMPONENT ${COMPONENT})
endfunction()
install_name(configs ${data} program)
install_name(tools/client/hilcam_client.h ${CMAKE_INSTALL_INCLUDEDIR}/hilcam/hilcam_client.h program)
install_name(tools/client/hilcam_shm.h ${CMAKE_INSTALL_INCLUDEDIR}/hilcam/hilcam_shm.h program)
install_name(tools/client/hilcam_client.py ${data}/client/hilcam_client.py program)
install_name(tools/client/hilcam_read_packets.py ${data}/client/hilcam_read_packets.py program)
install_name(tools/flight_software_example ${doc}-examples/examples/flight_software_example examples)
install_name(tools/landing_example ${doc}-examples/examples/landing_example examples)
install_name(tools/flight_software_glue ${doc}-examples/examples/flight_software_glue examples)

# --- the Python package, as Debian has such: pip installs it elsewhere ---
set(python_package lib/python3/dist-packages/hilcam)
install(DIRECTORY tools/python/hilcam/ DESTINATION ${python_package} COMPONENT python EXCLUDE_FROM_ALL
    FILES_MATCHING PATTERN "*.py" PATTERN py.typed PATTERN client.py EXCLUDE PATTERN __pycache__ EXCLUDE)
# In the source tree this is a link.
install(FILES tools/client/hilcam_client.py DESTINATION ${python_package} RENAME client.py COMPONENT python EXCLUDE_FROM_ALL)

# --- the examples ---
install(TARGETS hilcam-make-spacecraft RUNTIME DESTINATION ${HILCAM_INSTALL_HELPERDIR} COMPONENT examples)
install(DIRECTORY configs/scenarios configs/meshes DESTINATION ${data} COMPONENT examples)
install(DIRECTORY tools/flight_software_example tools/landing_example tools/flight_software_glue DESTINATION ${doc}-examples/examples COMPONENT examples)
install(FILES tools/quickstart_client.py DESTINATION ${doc}-examples/examples COMPONENT examples)
install(FILES tests/plugin/distance_plugin.cpp tests/plugin/hemisphere_plugin.cpp tests/plugin/random_plugin.cpp DESTINATION ${doc}-examples/examples/plugins COMPONENT examples)
install(FILES tools/packaging/examples.md DESTINATION ${doc}-examples/examples RENAME README.md COMPONENT examples)
