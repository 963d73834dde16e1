#pragma once

#include <utility>

namespace slideway {

/// What a map keeps under the key, or what is made now and kept.
template <typename Kept, typename Make>
const typename Kept::mapped_type& kept_or_made(Kept& kept, typename Kept::key_type key,
                                               const Make& make) {
  const auto found = kept.find(key);
  return found != kept.end() ? found->second : kept.emplace(std::move(key), make()).first->second;
}

}  // namespace slideway
