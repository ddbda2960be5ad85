// Images that were made once and are wanted again: the latest few, made by whoever needs one first.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace astroid {

/// @tparam Key  compared with ==. @thread safe
template <class Key, class Image>
class RecentImages {
 public:
  /// @param most  images that are kept; what somebody holds lives on.
  explicit RecentImages(std::size_t most) : most_(most) {}

  std::shared_ptr<const Image> get(const Key& key, const std::function<Image()>& make) const {
    const std::lock_guard lock(mutex_);  // whoever needs the same image has to wait for it anyway
    for (const auto& [at, image] : images_)
      if (at == key) return image;
    if (images_.size() == most_) images_.pop_front();
    images_.emplace_back(key, std::make_shared<const Image>(make()));
    return images_.back().second;
  }

 private:
  std::size_t most_;
  mutable std::mutex mutex_;
  mutable std::deque<std::pair<Key, std::shared_ptr<const Image>>> images_;  // the oldest first
};

}  // namespace astroid
