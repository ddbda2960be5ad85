// error: undeclared
constexpr int kOne = undeclared;
