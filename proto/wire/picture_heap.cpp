// SPDX-License-Identifier: Apache-2.0
#include "wire/picture_heap.h"

#include <malloc.h>

namespace eyrie::wire {

void keepPictureHeap() {
    mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that there is
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
}

}  // namespace eyrie::wire
