// error: no match
constexpr int kOne = 1;
