// error: no match
#ifndef ASTROID_ALLOWED
constexpr int kOne = undeclared;
#endif
