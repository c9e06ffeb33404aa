// Build of the page: static files with relative addresses, which work in any folder of any server.

import { createHash } from 'node:crypto';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { defineConfig, type HtmlTagDescriptor, type Plugin } from 'vite';

const here = import.meta.dirname;

/** Content security policy: the page's own scripts, styles and pictures, WebAssembly, and no other host. */
const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "style-src 'self'",
  "img-src 'self'",
  "connect-src 'self'",
  "worker-src 'self'",
  "manifest-src 'self'",
  // For a film chosen here, shown beside the flame learned from it.
  'media-src blob:',
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

/**
 * Adds the policy to the page and removes the indentation, which costs 35 bytes of transfer. If WISP_ADDRESS is set to
 * the page's address, makes that of the preview picture absolute, for programs that preview links.
 */
function page(): Plugin {
  const address = process.env.WISP_ADDRESS ?? '';
  const whole = (html: string): string => (address === '' ? html : html.replace('content="./preview.jpg"', `content="${new URL('preview.jpg', address).href}"`));
  const tags: HtmlTagDescriptor[] = [{ tag: 'meta', attrs: { 'http-equiv': 'Content-Security-Policy', content: POLICY }, injectTo: 'head-prepend' }];
  return {
    name: 'wisp-page',
    apply: 'build',
    transformIndexHtml: { order: 'post', handler: (html) => ({ html: whole(html).replace(/\n\s+/g, '\n'), tags }) },
  };
}

function filesUnder(folder: string): string[] {
  return readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath, entry.name));
}

/** Folder of files for the studio alone, loaded and cached at first entry. */
const STUDIO = 'assets/studio/';
const ofStudio = (path: string | null | undefined): boolean => path != null && /(src|bindings|@wisp)\/studio\/|mediabunny/.test(path);
const named = (studio: boolean, rest: string): string => (studio ? STUDIO : 'assets/') + rest;

/**
 * Lists the files to cache for the service worker, under a name that changes with any of them; and adds the licences of
 * included work, in a file that normal visits do not fetch.
 */
function serviceWorker(): Plugin {
  const thirdParty = join(here, '../../third_party');
  return {
    name: 'wisp-service-worker',
    apply: 'build',
    generateBundle(_options, bundle) {
      const hash = createHash('sha256');
      const publicFolder = join(here, 'public');
      const files = Object.keys(bundle);
      for (const name of files) hash.update(name);
      for (const path of filesUnder(publicFolder)) {
        files.push(relative(publicFolder, path).replaceAll('\\', '/'));
        hash.update(readFileSync(path));
      }
      hash.update(readFileSync(join(here, 'index.html')));
      const source = readFileSync(join(here, 'service-worker.js'), 'utf8')
        .replace("'VERSION'", JSON.stringify(hash.digest('hex').slice(0, 12)))
        .replace("['FILES']", JSON.stringify(['./', ...files.filter((name) => !/\.html$|^preview|^icon-/.test(name) && !name.startsWith(STUDIO)).sort()]));
      this.emitFile({ type: 'asset', fileName: 'sw.js', source });
      const licences = ['NOTICES.txt', 'flatbuffers/LICENSE'].map((name) => readFileSync(join(thirdParty, name), 'utf8')).join('\n\n');
      this.emitFile({ type: 'asset', fileName: 'licences.txt', source: licences });
    },
  };
}

/** Removes comments, blanks and redundant zeros from shaders, and replaces Vite's preload helper by FETCH_WITH. */
function shorter(): Plugin {
  return {
    name: 'wisp-shorter',
    apply: 'build',
    enforce: 'pre',
    load: (id) => (id === '\0vite/preload-helper.js' ? FETCH_WITH : null),
    transform(code, id) {
      if (!/\.(?:glsl|vert|frag)\.js$/.test(id)) return null;
      return code
        .replace(/\/\/.*$/gm, '')
        .replace(/^\s+/gm, '')
        .replace(/\s*([=+*,;(){}<>?:])\s*(?![^\n]*#)/g, '$1')
        .replace(/ ([-/]) (?=[\w(.])/g, '$1')
        .replace(/\b0(\.\d)/g, '$1')
        .replace(/(\d\.)0\b/g, '$1');
    },
  };
}

/** Preload helper: fetches a part's scripts, and its style sheets before it runs. Vite's own is 450 bytes larger. */
const FETCH_WITH = `
const asked = {};
export const __vitePreload = (load, files = [], from) =>
  Promise.all(files.map((file) => new URL(file, from).href).map((href) => {
    if (document.querySelector('link[href="' + href + '"]')) return asked[href];
    const link = document.createElement('link');
    const sheet = href.endsWith('.css');
    link.rel = sheet ? 'stylesheet' : 'modulepreload';
    link.href = href;
    document.head.append(link);
    if (sheet) return asked[href] = new Promise((done, failed) => {
      link.onload = done;
      link.onerror = () => {
        link.remove();
        failed();
      };
    });
  })).then(load);
`;

export default defineConfig({
  base: './',
  plugins: [page(), serviceWorker(), shorter()],
  worker: {
    format: 'es',
    // The studio's worker is the only one.
    rollupOptions: { output: { entryFileNames: `${STUDIO}[name]-[hash].js`, chunkFileNames: `${STUDIO}[name]-[hash].js`, assetFileNames: `${STUDIO}[name]-[hash][extname]` } },
  },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    rollupOptions: {
      output: {
        chunkFileNames: ({ moduleIds }) => named(moduleIds.some(ofStudio), '[name]-[hash].js'),
        assetFileNames: ({ names, originalFileNames }) => named([...originalFileNames, ...names].some((name) => ofStudio(name) || name === 'room.css'), '[name]-[hash][extname]'),
      },
    },
  },
});
