// SPDX-License-Identifier: Apache-2.0
import { clock_text } from "./time_text";

document.title = clock_text(0);
