#pragma once

namespace slideway {

/// Whether a sanitizer keeps shadow memory: memory limits and huge pages are then not used.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kHasShadow = true;
#elif defined(__has_feature)
inline constexpr bool kHasShadow =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kHasShadow = false;
#endif

}  // namespace slideway
