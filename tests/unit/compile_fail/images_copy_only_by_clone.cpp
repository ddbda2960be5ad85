// A copy of an image is megabytes: it must be asked for.
// error: use of deleted function
#include "astroid/core/image.hpp"

using Image = astroid::Image<double, astroid::unit::Adu>;

Image twin(const Image& image) {
#ifdef ASTROID_ALLOWED
  return image.clone();
#else
  return image;
#endif
}
