// How the page is built: static files with relative addresses, so that they can lie in any folder of any server.

import { createHash } from 'node:crypto';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { defineConfig, type Plugin } from 'vite';

const here = import.meta.dirname;

/** No other host, no script but the page's own. WebAssembly has to be allowed by name; a model is saved from a blob. */
const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "style-src 'self'",
  "img-src 'self'",
  "connect-src 'self'",
  "worker-src 'self'",
  "manifest-src 'self'",
  // A film that was chosen here, beside the flame that learned from it.
  'media-src blob:',
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

function policy(): Plugin {
  return {
    name: 'wisp-policy',
    apply: 'build',
    transformIndexHtml: () => [
      { tag: 'meta', attrs: { 'http-equiv': 'Content-Security-Policy', content: POLICY }, injectTo: 'head-prepend' },
    ],
  };
}

/** What is indented for whom writes it weighs 35 bytes on its way. */
function flatPage(): Plugin {
  return { name: 'wisp-flat-page', apply: 'build', transformIndexHtml: { order: 'post', handler: (html) => html.replace(/\n\s+/g, '\n') } };
}

function filesUnder(folder: string): string[] {
  return readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath, entry.name));
}

/** What belongs to the studio alone lies in a folder of its own: it is fetched, and kept, once somebody goes in. */
const STUDIO = 'assets/studio/';
const ofStudio = (path: string | null | undefined): boolean => path != null && /(src|bindings|@wisp)\/studio\/|mediabunny/.test(path);
const named = (studio: boolean, rest: string): string => (studio ? STUDIO : 'assets/') + rest;

/** Tells the service worker which files to keep, under a name that changes with any of them. */
function serviceWorker(): Plugin {
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
    },
  };
}

/** The licences of what others wrote and the page carries; for those who look, so no visitor fetches it. */
function licences(): Plugin {
  const thirdParty = join(here, '../../third_party');
  return {
    name: 'wisp-licences',
    apply: 'build',
    generateBundle() {
      const source = ['NOTICES.txt', 'flatbuffers/LICENSE'].map((name) => readFileSync(join(thirdParty, name), 'utf8')).join('\n\n');
      this.emitFile({ type: 'asset', fileName: 'licences.txt', source });
    },
  };
}

/** Shaders lose their comments, their blanks, and the zeros of their numbers. */
function shorterShaders(): Plugin {
  return {
    name: 'wisp-shorter-shaders',
    apply: 'build',
    enforce: 'pre',
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

/** What a part needs that comes later is fetched with it: its style sheets before it runs. Vite's own does the same for more browsers in 450 bytes more. */
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

function shorterPreload(): Plugin {
  return {
    name: 'wisp-shorter-preload',
    apply: 'build',
    enforce: 'pre',
    load: (id) => (id === '\0vite/preload-helper.js' ? FETCH_WITH : null),
  };
}

/** Programs that show links ask for whole addresses: WISP_ADDRESS says where the page will lie. */
function wholeAddresses(): Plugin {
  const address = process.env.WISP_ADDRESS ?? '';
  return {
    name: 'wisp-whole-addresses',
    apply: 'build',
    transformIndexHtml: (html) => (address === '' ? html : html.replace('content="./preview.jpg"', `content="${new URL('preview.jpg', address).href}"`)),
  };
}

export default defineConfig({
  base: './',
  plugins: [policy(), wholeAddresses(), flatPage(), serviceWorker(), licences(), shorterShaders(), shorterPreload()],
  worker: {
    format: 'es',
    // The studio's is the only one.
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
