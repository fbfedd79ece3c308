#pragma once

// The heavy headers nearly every translation unit needs; precompiled by CMake.
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <string>
#include <vector>
