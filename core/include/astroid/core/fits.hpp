// FITS, reading and writing.
#pragma once

#include "astroid/core/fits_card.hpp"          // IWYU pragma: export
#include "astroid/core/fits_image_series.hpp"  // IWYU pragma: export
#include "astroid/core/fits_reader.hpp"        // IWYU pragma: export
#include "astroid/core/fits_writer.hpp"        // IWYU pragma: export
