# What clothlab-bench --peers and clothlab-solvers-bench compare with, where it is found: docs/dependencies.md. Without it
# --peers says what to install.
option(CLOTHLAB_PEERS "Build what clothlab-bench --peers and clothlab-solvers-bench compare with, where it is installed" ON)

# Bullet's soft bodies (libbullet-dev): Debian has its library once in double precision and once in single, under the
# same names, so that each needs a program of its own.
set(clothlab_peer_definitions)
set(clothlab_peer_programs)
if(CLOTHLAB_PEERS)
  find_path(BULLET_SOFT_BODY_INCLUDE_DIR BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h PATH_SUFFIXES bullet)
else()
  unset(BULLET_SOFT_BODY_INCLUDE_DIR CACHE)
endif()

function(clothlab_bullet suffix ending)
  set(libraries)
  foreach(part BulletSoftBody BulletDynamics BulletCollision LinearMath)
    find_library(CLOTHLAB_${part}${ending} ${part}${ending})
    if(NOT CLOTHLAB_${part}${ending})
      return()
    endif()
    list(APPEND libraries ${CLOTHLAB_${part}${ending}})
  endforeach()
  set(library clothlab_bullet_cloth${suffix})
  add_library(${library} STATIC EXCLUDE_FROM_ALL peers/bullet_cloth.cpp)
  target_include_directories(${library} SYSTEM PRIVATE ${BULLET_SOFT_BODY_INCLUDE_DIR})
  target_compile_definitions(${library} PRIVATE ${ARGN})
  target_compile_options(${library} PRIVATE $<$<CONFIG:Release>:-O3>)
  set(warnings $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # false, on what Bullet's headers inline
  target_link_libraries(${library} PUBLIC clothlab_speed PRIVATE ${libraries})
  clothlab_target(${library})
  target_compile_options(${library} PRIVATE ${warnings})
  string(REPLACE _ - program clothlab-bullet${suffix})
  add_executable(${program} EXCLUDE_FROM_ALL peers/bullet_main.cpp)
  target_link_libraries(${program} PRIVATE ${library})
  clothlab_target(${program})
  set_target_properties(${library} ${program} PROPERTIES UNITY_BUILD OFF)
  string(TOUPPER CLOTHLAB_BULLET${suffix} definition)
  set(clothlab_peer_definitions ${clothlab_peer_definitions} ${definition}="$<TARGET_FILE:${program}>" PARENT_SCOPE)
  set(clothlab_peer_programs ${clothlab_peer_programs} ${program} PARENT_SCOPE)
endfunction()
if(BULLET_SOFT_BODY_INCLUDE_DIR)
  clothlab_bullet("" -float64 BT_USE_DOUBLE_PRECISION)
  clothlab_bullet(_single "")
endif()

if(TARGET clothlab_bullet_cloth)
  clothlab_test(clothlab_bullet_tests LABEL bench TIMEOUT 60
    SOURCES bullet_test.cpp
    LIBRARIES clothlab_bullet_cloth)
endif()

# What solves the linear systems of implicit Euler: CHOLMOD (libsuitesparse-dev) and hypre (libhypre-dev, which needs
# MPI).
set(clothlab_solver_sources)
set(clothlab_solver_definitions)
set(clothlab_solver_libraries)
set(clothlab_solver_includes)
if(CLOTHLAB_PEERS)
  find_path(CHOLMOD_INCLUDE_DIR suitesparse/cholmod.h)
  find_library(CHOLMOD_LIBRARY cholmod)
  find_path(HYPRE_INCLUDE_DIR HYPRE_parcsr_ls.h PATH_SUFFIXES hypre)
  find_library(HYPRE_LIBRARY HYPRE)
  set(MPI_CXX_SKIP_MPICXX ON)
  find_package(MPI QUIET COMPONENTS CXX)
  if(CHOLMOD_INCLUDE_DIR AND CHOLMOD_LIBRARY)
    list(APPEND clothlab_solver_sources solvers/cholmod_subjects.cpp)
    list(APPEND clothlab_solver_definitions CLOTHLAB_CHOLMOD)
    list(APPEND clothlab_solver_includes ${CHOLMOD_INCLUDE_DIR})
    list(APPEND clothlab_solver_libraries ${CHOLMOD_LIBRARY} ${CMAKE_DL_LIBS})
  endif()
  if(HYPRE_INCLUDE_DIR AND HYPRE_LIBRARY AND MPI_CXX_FOUND AND NOT CLOTHLAB_SANITIZE)  # MPI leaves memory behind
    list(APPEND clothlab_solver_sources solvers/hypre_subjects.cpp)
    list(APPEND clothlab_solver_definitions CLOTHLAB_HYPRE)
    list(APPEND clothlab_solver_includes ${HYPRE_INCLUDE_DIR})
    list(APPEND clothlab_solver_libraries ${HYPRE_LIBRARY} MPI::MPI_CXX)
  endif()
endif()
add_library(clothlab_solvers STATIC EXCLUDE_FROM_ALL
  solvers/newton_system.cpp solvers/our_subjects.cpp solvers/solver_study.cpp solvers/solver_tables.cpp
  ${clothlab_solver_sources})
target_include_directories(clothlab_solvers SYSTEM PRIVATE ${clothlab_solver_includes})
target_compile_definitions(clothlab_solvers PRIVATE ${clothlab_solver_definitions})
target_link_libraries(clothlab_solvers PUBLIC clothlab_speed
  PRIVATE nlohmann_json::nlohmann_json fmt::fmt ${clothlab_solver_libraries})
clothlab_target(clothlab_solvers)
