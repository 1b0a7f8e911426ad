"use strict";
// What the script of the moving picture finds on a report's page.
const ready = [], page = { views: [], dark: {} };
const other = (color, colors) => colors[color] ?? color;
