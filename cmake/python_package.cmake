# The Python package lidar_panoptic_clustering: the extension _core (src/python) and what is Python (python/). In a build
# folder the Python files are links, so that a change counts at once.

set(python_package_source ${CMAKE_CURRENT_SOURCE_DIR}/python/${PROJECT_NAME})

# Links the Python files into a folder of the build.
function(link_python_package folder)
  file(GLOB files RELATIVE ${python_package_source} CONFIGURE_DEPENDS ${python_package_source}/*.py
       ${python_package_source}/*.pyi ${python_package_source}/py.typed)
  file(MAKE_DIRECTORY ${folder})
  foreach(file ${files})
    file(CREATE_LINK ${python_package_source}/${file} ${folder}/${file} SYMBOLIC)
  endforeach()
endfunction()

# Before catkin generates anything: makes one package of what it generates into `generated` (messages, parameters) and
# of `folder`. catkin writes an empty __init__.py wherever there is none, and installs the whole of `generated`, links
# too. So all that lies there of ours is an __init__.py, which leads to the folder, and which catkin is told, as by
# catkin_python_setup(), not to install. (That function would run setuptools at installation and knows no extension made
# by cmake.)
macro(relay_python_package generated folder)
  set(python_package_folder ${folder})
  configure_file(cmake/python_relay.py.in ${generated}/__init__.py @ONLY)
  set(${PROJECT_NAME}_CATKIN_PYTHON_SETUP_HAS_PACKAGE_INIT TRUE)
endmacro()

# Looks for what the extension needs: sets `found`, Python3_INCLUDE_DIRS, pybind11_INCLUDE_DIR and python_suffix.
macro(find_python_extension found)
  if(NOT Python3_EXECUTABLE AND PYTHON_EXECUTABLE)
    set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE}) # catkin's
  endif()
  if(CMAKE_VERSION VERSION_LESS 3.18)
    find_package(Python3 QUIET COMPONENTS Interpreter Development)
  else()
    find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
  endif()
  set(PYBIND11_NOPYTHON ON) # headers are enough: each version of pybind11 has its own way to look for Python
  find_package(pybind11 QUIET CONFIG)
  set(${found} OFF)
  if(Python3_FOUND AND pybind11_FOUND)
    execute_process(
      COMMAND ${Python3_EXECUTABLE} -c "import sysconfig; print(sysconfig.get_config_var('EXT_SUFFIX'))"
      OUTPUT_VARIABLE python_suffix OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(${found} ON)
  endif()
endmacro()

# Builds _core into `folder`, and installs it with the Python files into `destination`, `library` being the way from
# there to the installed library.
function(add_python_extension folder destination library)
  file(GLOB sources CONFIGURE_DEPENDS src/python/*.cpp)
  #catkin_lint: ignore_once target_name_collision
  add_library(_core MODULE ${sources})
  target_include_directories(_core PRIVATE src)
  target_include_directories(_core SYSTEM PRIVATE ${pybind11_INCLUDE_DIR} ${Python3_INCLUDE_DIRS})
  target_link_libraries(_core PRIVATE ${PROJECT_NAME} ${PROJECT_NAME}_options nlohmann_json::nlohmann_json Threads::Threads)
  set_target_properties(
    _core PROPERTIES PREFIX "" SUFFIX "${python_suffix}" CXX_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${folder}
                     INSTALL_RPATH "$ORIGIN/${library}")
  install(TARGETS _core LIBRARY DESTINATION ${destination} COMPONENT python)
  if(NOT SKBUILD) # which takes the Python files itself
    install(DIRECTORY ${python_package_source}/ DESTINATION ${destination} COMPONENT python FILES_MATCHING
            PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
  endif()
endfunction()

# The tests of test/python, on the package as it lies in the build.
function(add_python_tests)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import pytest" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed)
    message(STATUS "no pytest for ${Python3_EXECUTABLE}: the Python package is not tested")
    return()
  endif()
  if(LIDAR_PANOPTIC_ROS)
    set(path ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION})
  else()
    get_filename_component(path ${python_build_folder} DIRECTORY)
  endif()
  set(tests ${CMAKE_CURRENT_SOURCE_DIR}/test/python)
  set(pytest ${Python3_EXECUTABLE} -m pytest -q -p no:cacheprovider)
  add_test(NAME python COMMAND ${pytest} ${tests} --ignore-glob ${tests}/cluster*)
  set(names python)
  file(GLOB cluster_tests CONFIGURE_DEPENDS ${tests}/cluster*_test.py)
  foreach(path ${cluster_tests})
    get_filename_component(name ${path} NAME_WE)
    # skipped, with the reason, where there is no Dask; status 5: no test was run
    add_test(NAME python_${name} COMMAND ${pytest} -rs ${path})
    set_tests_properties(python_${name} PROPERTIES SKIP_RETURN_CODE 5)
    list(APPEND names python_${name})
  endforeach()
  foreach(name ${names})
    set_tests_properties(
      ${name} PROPERTIES ENVIRONMENT "PYTHONPATH=${path}:$ENV{PYTHONPATH};PYTHONDONTWRITEBYTECODE=1;\
LIDAR_PANOPTIC_BENCHMARK=$<TARGET_FILE:panoptic_benchmark>;LIDAR_PANOPTIC_WORKSPACE=$<BOOL:${LIDAR_PANOPTIC_ROS}>")
  endforeach()
endfunction()
