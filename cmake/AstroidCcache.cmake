# Uses ccache when it is installed, so that every checkout of the project on a machine shares what was compiled: paths inside the
# checkout are hashed as relative ones. The sloppiness settings are what ccache's manual asks for with precompiled headers.
find_program(ASTROID_CCACHE ccache)
if(ASTROID_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${ASTROID_CCACHE})
endif()
