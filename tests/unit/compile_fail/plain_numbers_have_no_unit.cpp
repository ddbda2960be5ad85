// A number becomes a quantity only where its unit is named.
// error: conversion from 'double' to non-scalar type
#include "astroid/core/units.hpp"

#ifdef ASTROID_ALLOWED
constexpr astroid::Seconds kExposure = astroid::Seconds(21.0);
#else
constexpr astroid::Seconds kExposure = 21.0;
#endif
