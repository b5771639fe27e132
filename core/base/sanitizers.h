#pragma once

/// 1 where an address or thread sanitizer maps more memory than any limit allows, else 0.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ADAMAS_HAS_SHADOW_MEMORY 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ADAMAS_HAS_SHADOW_MEMORY 1
#endif
#endif
#ifndef ADAMAS_HAS_SHADOW_MEMORY
#define ADAMAS_HAS_SHADOW_MEMORY 0
#endif
