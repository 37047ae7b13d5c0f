// SPDX-License-Identifier: Apache-2.0
// What stays in the phone: token, who somebody is, language, light.

const kKept = "footlight-cast-";

/** A phone that keeps nothing asks again each time. */
export const kept = (name: string): string => {
  try {
    return localStorage.getItem(kKept + name) || "";
  } catch (_) {
    return "";
  }
};
export const keep = (name: string, value: string): void => {
  try {
    if (value) localStorage.setItem(kKept + name, value);
    else localStorage.removeItem(kKept + name);
  } catch (_) {
    return;
  }
};
