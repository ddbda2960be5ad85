// Constness of an image is deep: a view of constant pixels cannot change them.
// error: assignment of read-only location
#include "astroid/core/image.hpp"

void clear(
#ifdef ASTROID_ALLOWED
    astroid::ImageView<float, astroid::unit::Adu> image
#else
    astroid::ImageView<const float, astroid::unit::Adu> image
#endif
) {
  image.at(0, 0) = 0.0F;
}
