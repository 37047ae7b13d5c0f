# One target a folder. Include root is the repository; what a folder may link is what it may include.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# Programs that limit their own address space cannot run under a sanitizer: they take footlight_warnings alone.
add_library(footlight_warnings INTERFACE)
target_include_directories(footlight_warnings INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(footlight_warnings INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -fstack-protector-strong -ffp-contract=off
  $<$<BOOL:${FOOTLIGHT_WERROR}>:-Werror>
  $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>)
# -Wno-restrict: g++ 12 warns of std::string + at -O3 without cause (GCC bug 105651).
add_library(footlight_flags INTERFACE)
target_link_libraries(footlight_flags INTERFACE footlight_warnings)
if(FOOTLIGHT_SANITIZE)
  # g++ 12 sees uninitialised members in its own <regex> once a sanitizer is in; the dev build keeps the warning.
  target_compile_options(footlight_flags INTERFACE -fsanitize=${FOOTLIGHT_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(footlight_flags INTERFACE -fsanitize=${FOOTLIGHT_SANITIZE})
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
target_link_options(footlight_flags INTERFACE -Wl,-z,relro,-z,now)

# footlight_library(NAME sources... ) makes footlight_NAME.
function(footlight_library name)
  add_library(footlight_${name} STATIC ${ARGN})
  target_link_libraries(footlight_${name} PUBLIC footlight_flags)
endfunction()

# footlight_test(NAME sources...) makes NAME_tests, one program a folder, run by ctest as one test.
function(footlight_test name)
  add_executable(${name}_tests ${ARGN})
  target_link_libraries(${name}_tests PRIVATE footlight_flags GTest::gtest GTest::gmock GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name}_tests)
endfunction()

# footlight_optional(TARGET LIBRARY SOURCE WITHOUT pkg-config-names...): a library that footlight_TARGET uses in one source; without it
# another source stands in its place and says so. FOOTLIGHT_WITH_library tells tests which one it is.
function(footlight_optional target library source without)
  find_package(PkgConfig QUIET)
  if(PKG_CONFIG_FOUND AND NOT CMAKE_DISABLE_FIND_PACKAGE_${library})
    pkg_check_modules(${library} QUIET IMPORTED_TARGET GLOBAL ${ARGN})
  endif()
  if(TARGET PkgConfig::${library})
    target_sources(footlight_${target} PRIVATE ${source})
    target_link_libraries(footlight_${target} PRIVATE PkgConfig::${library})
    target_compile_definitions(footlight_${target} INTERFACE FOOTLIGHT_WITH_${library}=1)
  else()
    message(STATUS "${library} not found: built without it")
    target_sources(footlight_${target} PRIVATE ${without})
    target_compile_definitions(footlight_${target} INTERFACE FOOTLIGHT_WITH_${library}=0)
  endif()
endfunction()
