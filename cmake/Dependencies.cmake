# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Every third-party library, in one place. The packages are in scripts/packages.txt.
find_package(Eigen3 3.4 REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs videoio calib3d rgbd)
foreach(library IN ITEMS obs maps opengl vision tfest slam img io serialization system math poses config)
  find_package(mrpt-${library} 2.5 REQUIRED)
endforeach()
find_package(verilator 5.006 REQUIRED HINTS $ENV{VERILATOR_ROOT})
find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
