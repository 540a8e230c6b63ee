// SPDX-License-Identifier: Apache-2.0
// The last script: everything that answers the worker is there.
"use strict";

showParts();
startWorker();
