# The compiler of the preset fuzz, chosen before project(): a clang with libFuzzer.
if(NOT CMAKE_CXX_COMPILER)
  find_program(OPAL_CLANG NAMES clang++ clang++-14)
  if(NOT OPAL_CLANG)
    message(FATAL_ERROR "The preset fuzz needs clang: apt-get install clang-14 libclang-rt-14-dev (Debian 12)")
  endif()
  set(CMAKE_CXX_COMPILER ${OPAL_CLANG})
endif()
