#pragma once
// Requests on a FunctionFS device's control endpoint (linux/usb/functionfs.h).

#include <linux/usb/functionfs.h>
#include <unistd.h>

#include "io/system/fd.h"

namespace hilcam {

// Refuses a control request, of which we handle none: input or output in the wrong direction stalls.
inline void refuse_request(const Fd& control, const usb_functionfs_event& event) {
    if (event.u.setup.bRequestType & USB_DIR_IN) [[maybe_unused]]
        const auto got = ::read(control.get(), nullptr, 0);
    else [[maybe_unused]]
        const auto put = ::write(control.get(), nullptr, 0);
}

}  // namespace hilcam
